"""Imported once by the fork server: what is loaded here is shared by every fit it forks."""

from service.worker import pipeline

pipeline.describe()
