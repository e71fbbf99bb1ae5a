"""Rows of jobs as they are stored, for tests that write them without the engine."""

from typing import Any

import sqlalchemy as sa

from service.jobs.rows import Endings
from service.jobs.tables import JOBS

ENDINGS = Endings(retention_s=60.0, notify=lambda *_: None)
"""Nobody is told."""


def insert_job(connection: sa.Connection, name: str, **values: Any) -> None:
    """Insert a fit that waits, but for what ``values`` say."""
    row: dict[str, Any] = {
        "id": name,
        "tenant": "default",
        "kind": "fit",
        "pictures": 1,
        "turn": 0,
        "state": "queued",
        "progress": 0.0,
        "attempt": 0,
        "crashes": 0,
        "cancel_requested": False,
        "created_at": 1.0,
        "options_digest": "0" * 64,
        "inputs": "{}",
        "files": "[]",
        "last_event": 0,
    }
    connection.execute(sa.insert(JOBS).values(row | values))
