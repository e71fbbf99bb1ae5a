"""Names DBOS knows our work by, shared by those who enqueue and those who run."""

from typing import Final

APPLICATION: Final = "maquette"
QUEUE: Final = "fits"
WORKFLOW: Final = "fit"
EXECUTION_VERSION: Final = "1"
"""DBOS's application version: names the meaning of checkpoints, not of the code. Raised only when
a stored checkpoint can no longer be continued; workers run jobs of their own version alone."""
