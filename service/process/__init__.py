"""Foundations of every process of the service: folders, logs, confinement, retries."""
