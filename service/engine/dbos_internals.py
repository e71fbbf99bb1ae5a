"""All uses of DBOS's private interfaces; nothing else in the service may touch them.

Each function says what it is for and what the public way would cost. The version of DBOS is pinned
in ``pyproject.toml``, and ``tests/unit/service/test_dbos_internals.py`` fails on a version that
changes what is used here. Figures: DECISIONS.md, "What DBOS does not publish is in one module".
"""

import time
from collections.abc import Callable, Collection
from typing import Any, Final

from dbos import DBOS, Queue, _sys_db
from sqlalchemy.exc import OperationalError

LONGEST_PAUSE_S: Final = 2.0
"""How long DBOS pauses at most before it repeats what failed for want of the database."""

AWAY_PAUSE_S: Final = 1.0
"""How long to pause before a poll while the database is away."""

LOOK_S: Final = 0.01
"""How long DBOS itself pauses between two polls, in which what it has begun comes to be counted;
``await_turn`` decides when it polls."""


def put_back_executions_of(dead: Collection[str]) -> None:
    """Put the executions of dead executors back into their queue, each once, keeping its count.

    *Private:* ``DBOS._recover_pending_workflows``, which is what DBOS calls for its own paid
    service. It changes an execution only while that is recorded as run by one of the dead, so if
    several notice a death only the first puts it back, and it does not touch the count of
    recoveries.

    *The public way*, ``DBOS.resume_workflow``, resets the count, so that a job that kills its
    worker would be restarted for ever; and it does not check who is running the execution now, so
    the second to notice would have it run twice at the same time.
    """
    DBOS._recover_pending_workflows(list(dead))


class _ShortPauses:
    """The module ``time``, but for how long it sleeps at most."""

    def __getattr__(self, name: str) -> Any:
        return getattr(time, name)

    def sleep(self, seconds: float) -> None:
        """Sleep for no longer than the longest pause."""
        time.sleep(min(seconds, LONGEST_PAUSE_S))


def shorten_pauses() -> None:
    """Have DBOS repeat its own writes every two seconds while the database is away or full.

    *Private:* the ``time`` by which ``db_retry`` of DBOS's ``_sys_db`` sleeps, which is replaced.

    *The public way* is none: the pauses double up to a minute and a half, so that a worker that was
    recording something when the database went stands still for as long again after its return.
    """
    _sys_db.time = _ShortPauses()  # pyright: ignore


def pace_queue(
    dbos: DBOS,
    paced_name: str,
    *,
    await_turn: Callable[[], None],
    usable_slots: Callable[[], int],
) -> None:
    """Let this process decide when DBOS polls a queue, and how many jobs run at the same time.

    DBOS, which must be launched, waits in ``await_turn`` before it claims anything, then keeps to
    ``usable_slots``; with 0 it claims nothing. As long as ``await_turn`` does not return, running
    executions go on and their ends are recorded.

    *Private:* DBOS reads the queue's record before each poll with ``get_queue`` of its ``_sys_db``,
    pauses for ``_polling_interval_sec`` of the queue, asks ``dequeue_scopes`` from where to claim,
    and claims as many as ``_worker_concurrency`` lets it. The two functions are replaced here. It
    waits in the second: nothing is between its turn and the claim.

    *The public way*, ``worker_concurrency`` and ``polling_interval_sec`` of ``register_queue``, is
    one record for all machines: the same number of slots on each of them, no holding back where one
    disk is full, and polls at a fixed pace, which leave a slot empty after each job and go on while
    none is free. The registered record is the fallback in case this way in disappears.
    """
    system_database = dbos._sys_db
    get_queue, dequeue_scopes = system_database.get_queue, system_database.dequeue_scopes
    paced: Queue | None = None

    def get_paced_queue(name: str, **options: Any) -> Queue | None:
        nonlocal paced
        try:
            queue = get_queue(name, **options)
        except OperationalError:
            # DBOS logs each of these, and polls again at once.
            time.sleep(AWAY_PAUSE_S)
            raise
        if queue is not None and queue.name == paced_name:
            queue._polling_interval_sec = LOOK_S
            paced = queue
        return queue

    def dequeue_scopes_in_turn(queue_name: str) -> list[str | None]:
        if queue_name == paced_name:
            await_turn()
            if paced is None:
                return []
            paced._worker_concurrency = usable_slots()
        return dequeue_scopes(queue_name)

    system_database.get_queue = get_paced_queue
    system_database.dequeue_scopes = dequeue_scopes_in_turn
