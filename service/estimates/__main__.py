"""An estimator of the API that started it: ``python -m service.estimates SOCKET``."""

import sys
from multiprocessing.connection import Connection

from service.estimates.main import run_estimator
from service.startup.begin import begin, run_told

if __name__ == "__main__":
    settings = begin("estimator")
    connection = Connection(int(sys.argv[-1]))
    sys.exit(run_told("estimator", lambda: run_estimator(settings, connection)))
