"""A worker with the fake pipeline: ``python -m tests.integration.service.fake_worker``."""

import os
import sys
from pathlib import Path

FAKE = "tests.integration.service.fake_pipeline"
FAKE_ESTIMATOR = "tests.integration.service.fake_forked_estimator"
FAKE_SECRETLESS = "tests.integration.service.fake_secretless"
FAKE_PRELOAD = "tests.integration.service.fake_preload"
FAKE_MODELS = (sys.executable, "-m", "tests.integration.service.fake_models")


def main() -> None:
    # Imported here: every forked child imports this module again, and is to start quickly.
    from service.process.logs import configure_logging
    from service.settings import Settings
    from service.worker.main import run_worker

    # The processes that a worker starts look for nothing in the current folder.
    os.environ["PYTHONPATH"] = str(Path(__file__).parents[3])
    settings = Settings()
    configure_logging(settings.log_level, settings.log_format)
    run_worker(
        settings,
        follow_stdin=True,
        pipeline=FAKE,
        secretless=FAKE_SECRETLESS,
        preload=FAKE_PRELOAD,
        estimator=FAKE_ESTIMATOR,
        models_command=FAKE_MODELS,
    )


if __name__ == "__main__":
    main()
