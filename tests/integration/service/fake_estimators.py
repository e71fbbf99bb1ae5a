"""Fake estimators alone: ``python -m tests.integration.service.fake_estimators fake ADDRESS``."""

import os
import sys
from pathlib import Path


def main(estimates: str, questions_at: str) -> None:
    # Imported here: every forked child imports this module again, and is to start quickly.
    from service.compute.worker import run_estimators
    from service.process.logs import configure_logging
    from service.settings import Settings
    from tests.integration.service.fake_worker import ESTIMATES, FAKE_PRELOAD

    os.environ["PYTHONPATH"] = str(Path(__file__).parents[3])
    settings = Settings()
    configure_logging(settings.log_level, settings.log_format)
    run_estimators(
        settings,
        questions_at=questions_at,
        estimates=ESTIMATES[estimates],
        preload=FAKE_PRELOAD,
    )


if __name__ == "__main__":
    main(*sys.argv[1:])
