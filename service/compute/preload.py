"""Imported once by the fork server: what is loaded here is shared by every process it forks."""

import logging
import os
import signal
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Final

from service.process.caches import KERNELS, VARIABLE, keep_kernels, link_kernels, settle_folders
from service.process.confinement import write_only_below
from service.settings import Settings

LOG: Final = logging.getLogger(__name__)

LOOK_S: Final = 1.0
"""So often a process that loads looks whether its worker is still there."""


@contextmanager
def _ending_with_the_worker() -> Iterator[None]:
    """End this process if the worker ends meanwhile: its folder with the kernels is gone then.

    They would be compiled anew, for minutes, and nobody would use them.
    """
    worker = os.getppid()

    def look(*_: object) -> None:
        if os.getppid() != worker:
            os._exit(0)

    before = signal.signal(signal.SIGALRM, look)
    # Libraries go on with what they wait for.
    signal.siginterrupt(signal.SIGALRM, False)
    signal.setitimer(signal.ITIMER_REAL, LOOK_S, LOOK_S)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0.0)
        signal.signal(signal.SIGALRM, before)


def _load(settings: Settings) -> None:
    # Imported here: Numba reads once where its cache is.
    from fitter.detection.detector import installed_detector
    from fitter.errors import DetectorUnavailableError, ModelFileError
    from fitter.fits.prepared_model import prepared_model
    from fitter.vocabulary.choices import Gender
    from service.compute.kernels import make_kernels_ready

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
            prepared_model(gender, models=settings.models_dir)


if VARIABLE not in os.environ:
    # Imported by another than a worker, who has done it.
    settle_folders()

# Whoever decodes pictures can write to this folder alone, and nobody reads what it writes there
# but others that are forked here: what is kept is copied before.
KEPT: Final = Path(os.environ[KERNELS]) if os.environ.get(KERNELS) else None
OWN: Final = Path(tempfile.mkdtemp(prefix="kernels-"))
link_kernels(OWN, KEPT)
os.environ[KERNELS] = str(OWN)
with _ending_with_the_worker():
    _load(Settings())
    keep_kernels(OWN, KEPT)

# From here on pictures are decoded, in what is forked: what it may write ends with the worker.
write_only_below(os.environ["TMPDIR"])
