"""The service with the fake pipeline; with ``api-only`` its workers are run by the test."""

import sys

from service.logs import configure_logging
from service.serve import listen, serve
from service.settings import Settings

FAKE_WORKER = (sys.executable, "-m", "tests.integration.service.fake_worker")

if __name__ == "__main__":
    settings = Settings()
    configure_logging(settings.log_level)
    serve(
        settings,
        listen(settings),
        worker_command=None if "api-only" in sys.argv else FAKE_WORKER,
        announce=lambda text: print(text, flush=True),
    )
