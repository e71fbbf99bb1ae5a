"""An estimator of the API that started it: ``python -m service.estimates SOCKET``."""

import os
import sys
from multiprocessing.connection import Connection

from service.estimates.answering import Answers
from service.estimates.main import prepare_here, run_estimator
from service.process.caches import settle_folders
from service.process.confinement import forget_secrets, write_only_below
from service.settings import Settings
from service.startup.begin import begin, run_told


def main() -> int:
    """Have the kernels ready, and answer."""
    settings = begin("estimator")
    forget_secrets()
    connection = Connection(int(sys.argv[-1]))
    settle_folders()
    return run_told("estimator", lambda: run_estimator(settings, connection, prepare=prepare))


def prepare(module: Answers, settings: Settings) -> None:
    """Prepare with kernels that are kept from one process to the next."""
    # Imported here: Numba reads once where its cache is, which had to be settled before.
    from service.worker.rehearsal import make_ready

    make_ready(settings.models_dir, settings.detector_dir)
    prepare_here(module, settings)
    write_only_below(os.environ["TMPDIR"])


if __name__ == "__main__":
    sys.exit(main())
