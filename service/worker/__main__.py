"""Run a worker that ends with the process that started it: ``python -m service.worker``."""

import sys

from service.startup.begin import begin, run_told
from service.worker.main import run_worker

if __name__ == "__main__":
    settings = begin("worker")
    sys.exit(run_told("worker", lambda: run_worker(settings, follow_stdin=True)))
