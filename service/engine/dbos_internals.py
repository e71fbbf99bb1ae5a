"""All that the engine uses of DBOS without DBOS publishing it; nothing else in the service may.

Each function says what it is for and what the public way would cost. The version of DBOS is pinned
in ``pyproject.toml``, and ``tests/unit/service/test_dbos_internals.py`` fails on one that changes
what is used here. Figures: DECISIONS.md, "What DBOS does not publish is in one module".
"""

from collections.abc import Callable, Collection
from typing import Any, Final

from dbos import DBOS, Queue

LOOK_S: Final = 0.01
"""How long DBOS itself pauses between two looks for jobs; ``await_turn`` says when it looks."""


def put_back_executions_of(dead: Collection[str]) -> None:
    """Put the executions of dead executors back into their queue, each once and still counted.

    *Private:* ``DBOS._recover_pending_workflows``, which is what DBOS calls for its own paid
    service. It changes an execution only while that stands as run by one of the dead, so of several
    who notice a death only the first puts it back, and it leaves the count of recoveries alone.

    *The public way*, ``DBOS.resume_workflow``, sets the count to nothing, so that a job that kills
    its worker would be begun for ever; and it does not ask who runs the execution now, so whoever
    comes second has it run twice side by side.
    """
    DBOS._recover_pending_workflows(list(dead))


def stop_claiming(dbos: DBOS) -> None:
    """Let DBOS claim nothing more, while what runs goes on and its end is noted.

    *Private:* ``background_thread_stop_events``, the events that end DBOS's own threads.

    *The public way*, ``DBOS.destroy(workflow_completion_timeout_sec=...)``, looks once a second
    whether all is done, waits for whole seconds, and then takes the database from DBOS: attempts
    that are still running could be neither handed back nor ended.
    """
    for stop in dbos.background_thread_stop_events:
        stop.set()


def pace_queue(
    dbos: DBOS,
    queue_name: str,
    *,
    await_turn: Callable[[], None],
    usable_slots: Callable[[], int],
) -> None:
    """Let this process alone say when DBOS looks into a queue, and how many jobs run side by side.

    DBOS, which must be launched, waits in ``await_turn`` before each look, then keeps to
    ``usable_slots``; with 0 it claims nothing.

    *Private:* DBOS reads the queue's record before each look by ``get_queue`` of its ``_sys_db``,
    which is replaced here, and keeps what it read in ``_worker_concurrency`` and
    ``_polling_interval_sec`` of the queue.

    *The public way*, ``worker_concurrency`` and ``polling_interval_sec`` of ``register_queue``, is
    one record for all machines: as many slots on each of them, no holding back where one disk is
    full, and looks at a fixed pace, which leave a slot empty after each job and go on while none
    is free. The record that is registered is the floor, should this way in be gone.
    """
    system_database = dbos._sys_db
    get_queue = system_database.get_queue

    def get_queue_in_turn(name: str, **options: Any) -> Queue | None:
        if name == queue_name:
            await_turn()
        queue = get_queue(name, **options)
        if queue is not None and queue.name == queue_name:
            queue._worker_concurrency = usable_slots()
            queue._polling_interval_sec = LOOK_S
        return queue

    system_database.get_queue = get_queue_in_turn
