"""A worker beside the API that started it: ``python -m service.compute [questions] ADDRESS``.

It answers the API's questions at that address, with ``questions`` nothing else, and ends with it.
"""

import sys

from service.compute.worker import run_estimators, run_worker
from service.startup import run_service

if __name__ == "__main__":
    *only, address = sys.argv[1:]
    name, run = ("estimator", run_estimators) if only else ("worker", run_worker)
    sys.exit(run_service(name, lambda settings: run(settings, questions_at=address)))
