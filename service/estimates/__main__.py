"""Run the estimators of an API without a worker: ``python -m service.estimates ADDRESS``.

They answer its questions at that address, and end with it.
"""

import sys

from service.compute.main import run_estimators
from service.startup import run_service

if __name__ == "__main__":
    sys.exit(
        run_service(
            "estimator", lambda settings: run_estimators(settings, questions_at=sys.argv[1])
        )
    )
