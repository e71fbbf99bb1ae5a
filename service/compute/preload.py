"""Imported once by the fork server: what is loaded here is shared by every process it forks."""

import logging
import os
import tempfile
from contextlib import suppress
from pathlib import Path
from typing import Final

from service.compute.kernels import (
    VARIABLE,
    compile_once,
    import_kernels,
    link_kernels,
    make_kernels_ready,
    settle_folders,
)
from service.process.confinement import ending_with_the_parent
from service.process.work_folder import VARIABLE as TEMPORARY
from service.process.work_folder import is_abandoned
from service.settings import Settings

LOG: Final = logging.getLogger(__name__)


def _load(settings: Settings) -> None:
    # Imported here: Numba reads once where its cache is.
    from fitter.applications.rings import RingCoordinates
    from fitter.detection.detector import installed_detector
    from fitter.errors import DetectorUnavailableError, ModelFileError
    from fitter.fits.equipment import prepared_model
    from fitter.vocabulary.choices import Gender

    import_kernels()
    # Without a detector, whoever needs it is told.
    with suppress(DetectorUnavailableError):
        installed_detector(settings.detector_dir)
    # The worker has the same models read and reports what is wrong with them.
    with suppress(ModelFileError):
        try:
            make_kernels_ready(settings.detector_dir)
        except ModelFileError:
            raise
        except Exception:
            LOG.exception("The sample could not be fitted: every fit takes longer.")
        for gender in Gender:
            RingCoordinates.of(prepared_model(gender, models=settings.models_dir).operators.model)


def _keep_no_more() -> None:
    """Have Numba keep in memory alone what a child compiles."""
    from numba.core.caching import Cache

    Cache.save_overload = lambda *_: None  # pyright: ignore[reportAttributeAccessIssue]


if VARIABLE not in os.environ:
    # Imported by another than a worker, who has done it.
    settle_folders()

# Children load kernels from this folder and cannot write there: others would run what one wrote.
KEPT: Final = Path(os.environ[VARIABLE]) if os.environ.get(VARIABLE) else None
compile_once()
OWN: Final = Path(tempfile.mkdtemp(prefix="kernels-"))
link_kernels(OWN, KEPT)
os.environ[VARIABLE] = str(OWN)
# The folder is gone with the worker: kernels would be compiled that nobody uses.
with ending_with_the_parent():
    # A worker that died before holds its folder no longer, and nobody would end this process.
    if is_abandoned(Path(os.environ[TEMPORARY])):
        os._exit(0)
    _load(Settings())
    _keep_no_more()
