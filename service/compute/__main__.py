"""Run a worker beside the API that started it: ``python -m service.compute ADDRESS``.

It answers the API's questions at that address, and ends with it.
"""

import sys

from service.compute.main import run_worker
from service.startup import run_service

if __name__ == "__main__":
    sys.exit(run_service("worker", lambda settings: run_worker(settings, questions_at=sys.argv[1])))
