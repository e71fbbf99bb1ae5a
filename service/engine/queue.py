"""Names by which DBOS knows our work, shared by those who run it and those who erase it."""

from typing import Final

APPLICATION: Final = "maquette"
WORKFLOW: Final = "fit"
EXECUTION_VERSION: Final = "1"
"""DBOS's application version: that of the checkpoints' meaning, not of the code. Raised only when
stored checkpoints can no longer be continued; workers run only jobs of their own version."""


def queue_of(executor_id: str) -> str:
    """Name the queue on which a worker continues executions that others have begun."""
    return f"fits-{executor_id}"
