"""An estimator with the fake answers: ``python -m tests.integration.service.fake_estimator``."""

import sys
from multiprocessing.connection import Connection

from service.estimates.main import run_estimator
from service.process.logs import configure_logging
from service.settings import Settings

if __name__ == "__main__":
    settings = Settings()
    configure_logging(settings.log_level)
    connection = Connection(int(sys.argv[-1]))
    run_estimator(settings, connection, answers="tests.integration.service.fake_answers")
