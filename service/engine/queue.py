"""Names by which DBOS knows our work, shared by those who enqueue it and those who run it."""

from typing import Final

APPLICATION: Final = "maquette"
QUEUE: Final = "fits"
WORKFLOW: Final = "fit"
EXECUTION_VERSION: Final = "1"
"""DBOS's application version: that of the checkpoints' meaning, not of the code. Raised only when
stored checkpoints can no longer be continued; workers run only jobs of their own version."""
