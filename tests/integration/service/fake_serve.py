"""The service with the fake pipeline; with ``--no-worker`` its workers are run by the test.

Its estimators answer what they are told, are ``broken``, or are the ``real`` ones.
"""

import argparse
import sys
from pathlib import Path

from service.commands.serve import serve
from service.process.listener import listen
from service.process.logs import configure_logging
from service.settings import Settings

FAKE_WORKER = (sys.executable, "-m", "tests.integration.service.fake_worker")
FAKE_ESTIMATORS = (sys.executable, "-m", "tests.integration.service.fake_estimators")

if __name__ == "__main__":
    parser = argparse.ArgumentParser()
    parser.add_argument("--no-worker", action="store_true")
    parser.add_argument("--estimator", choices=("fake", "broken", "real"), default="fake")
    parser.add_argument("--data-dir", type=Path)
    parsed = parser.parse_args()
    given = {} if parsed.data_dir is None else {"data_dir": parsed.data_dir, "port": 0}
    settings = Settings(**given)
    configure_logging(settings.log_level, settings.log_format)
    serve(
        settings,
        listen(settings),
        worker_command=None if parsed.no_worker else (*FAKE_WORKER, parsed.estimator),
        # Those that are broken end at once.
        estimators_command=(*FAKE_ESTIMATORS, parsed.estimator),
        announce=lambda text: print(text, flush=True),
    )
