"""Run a worker beside the API that started it: ``python -m service.compute ADDRESS``.

It answers the API's questions at that address, and ends with it.
"""

import sys

from service.compute.main import run_worker
from service.startup import begin, run_told

if __name__ == "__main__":
    settings = begin("worker")
    sys.exit(run_told("worker", lambda: run_worker(settings, questions_at=sys.argv[1])))
