"""A worker with the fake pipeline: ``python -m tests.integration.service.fake_worker``.

Beside an API it is told what its estimators are, and the address of the API's questions; it answers
none if they are broken. It stops with whoever started it in any case, unlike ``maquette worker``.
"""

import os
import signal
import sys
import threading
from pathlib import Path

FAKE = "tests.integration.service.fake_pipeline"
ESTIMATES = {"fake": "tests.integration.service.fake_answers", "real": "service.compute.answers"}
FAKE_PRELOAD = "tests.integration.service.fake_preload"
REAL_PRELOAD = "service.compute.preload"


def stop_with_starter() -> None:
    while os.read(sys.stdin.fileno(), 1_024):
        pass
    os.kill(os.getpid(), signal.SIGTERM)


def main(estimates: str = "broken", questions_at: str | None = None) -> None:
    # Imported here: every forked child imports this module again, and is to start quickly.
    from service.compute.worker import run_worker
    from service.process.logs import configure_logging
    from service.settings import Settings
    from tests.integration.service.fake_pipeline import describe

    # The processes that a worker starts look for nothing in the current folder.
    os.environ["PYTHONPATH"] = str(Path(__file__).parents[3])
    threading.Thread(target=stop_with_starter, daemon=True).start()
    settings = Settings()
    configure_logging(settings.log_level, settings.log_format)
    run_worker(
        settings,
        questions_at=questions_at if estimates in ESTIMATES else None,
        pipeline=FAKE,
        estimates=ESTIMATES.get(estimates),
        # Real answers have ten seconds: not enough to compile their kernels.
        preload=REAL_PRELOAD if estimates == "real" else FAKE_PRELOAD,
        read_models=describe,
    )


if __name__ == "__main__":
    main(*sys.argv[1:])
