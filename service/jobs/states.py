"""Job states and their legal transitions.

::

    queued <─> running ──> succeeded | failed | canceled | timed_out
       └─────────────────> failed | canceled

A running job goes back to the queue when its worker is stopped. When the worker dies instead, the
job is run again with the next attempt: running ──> running.
"""

from collections.abc import Mapping
from typing import Final

from api_schemas.jobs import JobState

ACTIVE: Final = frozenset({JobState.QUEUED, JobState.RUNNING})
TERMINAL: Final = frozenset(JobState) - ACTIVE

TRANSITIONS: Final[Mapping[JobState, frozenset[JobState]]] = {
    JobState.QUEUED: frozenset({JobState.RUNNING, JobState.FAILED, JobState.CANCELED}),
    JobState.RUNNING: ACTIVE | TERMINAL,
} | {state: frozenset[JobState]() for state in TERMINAL}


def may_become(state: JobState) -> frozenset[JobState]:
    """The states from which a job may enter ``state``."""
    return frozenset(source for source, targets in TRANSITIONS.items() if state in targets)
