"""Logging of the entry points. No record carries pictures, points or other personal data."""

import logging


def configure_logging(level: str) -> None:
    """Log to standard error, one line a record."""
    logging.basicConfig(
        level=level.upper(), format="%(asctime)s %(levelname)s %(name)s: %(message)s", force=True
    )
    # DBOS tells every migration and launch at INFO; what matters of jobs we log ourselves.
    logging.getLogger("dbos").setLevel(max(logging.WARNING, logging.getLogger().level))
