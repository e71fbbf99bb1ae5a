"""Imported once by the fork server: what is loaded here is shared by every fit it forks."""

import gc
from contextlib import suppress

from fitter.errors import ModelFileError
from fitter.fits.prepared_model import prepared_model
from fitter.request import Gender
from service.settings import Settings
from service.worker.rehearsal import rehearse

# The worker has the same models read and reports what is wrong with them.
with suppress(ModelFileError):
    settings = Settings()
    for gender in Gender:
        prepared_model(gender, models=settings.models_dir)
    rehearse(settings.models_dir, settings.detector_dir)

# What is here by now stays: the collector of a fork that looked through it would copy its pages.
gc.collect()
gc.freeze()
