"""Imported once by the fork server: what is loaded here is shared by every process it forks."""

import gc
import os
from contextlib import suppress

from service.process.caches import KERNELS, settle_folders
from service.process.confinement import write_only_below
from service.process.heap import give_back, give_back_files


def _load() -> None:
    if not os.environ.get(KERNELS):
        # Imported by another than a worker, who has done it.
        settle_folders()
    # Imported here: nothing is looked through for cycles meanwhile.
    from fitter.errors import ModelFileError
    from fitter.fits.prepared_model import prepared_model
    from fitter.vocabulary.choices import Gender
    from service.settings import Settings
    from service.worker.rehearsal import make_ready, rehearse_sandbox

    # The worker has the same models read and reports what is wrong with them.
    with suppress(ModelFileError):
        settings = Settings()
        # First: preparing a model compiles what is not compiled yet, and keeps what that took.
        prepare = rehearse_sandbox if settings.sandbox else make_ready
        prepare(settings.models_dir, settings.detector_dir)
        for gender in Gender:
            prepared_model(gender, models=settings.models_dir)


gc.disable()
_load()

# What is here by now stays: the collector of a fork that looked through it would copy its pages.
# What has been freed would be copied too, where a fork writes to it.
gc.freeze()
gc.enable()
give_back()
give_back_files()

# From here on pictures are decoded, in what is forked: what it may write ends with the worker.
write_only_below(os.environ["TMPDIR"])
