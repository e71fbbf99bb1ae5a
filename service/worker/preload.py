"""Imported once by the fork server: what is loaded here is shared by every fit it forks."""

from contextlib import suppress

from fitter.errors import ModelFileError
from service.settings import Settings
from service.worker import pipeline

# The worker asks for the same at once, and is told what is wrong with a model.
with suppress(ModelFileError):
    pipeline.describe(Settings().models_dir)
