"""Run a worker that ends with whoever started it: ``python -m service.worker``."""

from service.logs import configure_logging
from service.settings import Settings
from service.worker.main import run_worker

if __name__ == "__main__":
    settings = Settings()
    configure_logging(settings.log_level, settings.log_format)
    run_worker(settings, follow_stdin=True)
