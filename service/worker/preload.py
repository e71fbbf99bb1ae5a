"""Imported once by the fork server: what is loaded here is shared by every fit it forks."""

import gc
from contextlib import suppress

from fitter.errors import ModelFileError
from service.settings import Settings
from service.worker import pipeline
from service.worker.rehearsal import rehearse

# The worker loads the same models at once and reports what is wrong with them.
with suppress(ModelFileError):
    settings = Settings()
    pipeline.describe(settings.models_dir)
    rehearse(settings.models_dir, settings.detector_dir)

# What is here by now stays: the collector of a fork that looked through it would copy its pages.
gc.collect()
gc.freeze()
