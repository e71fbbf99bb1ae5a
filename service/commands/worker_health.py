"""``maquette health --worker``: the health check of a worker's container."""

import time
from typing import Final

import sqlalchemy as sa

from service.commands.api_health import unhealthy
from service.jobs.database import available, open_database
from service.jobs.liveness import WorkerWatch, this_machine
from service.jobs.records import DatabaseUnusableError, EngineUnavailableError
from service.jobs.tables import WORKERS
from service.settings import Settings

LATE_S: Final = 10.0
"""How much later than its interval a beat may come: fits keep a machine busy. Together with the
interval this is less than docker/compose.yaml gives this command."""

LOOK_S: Final = 0.1

NOT_ALIVE: Final = "no worker of this machine is alive"
NOT_ABLE: Final = "no worker of this machine can start processes for jobs; its log says why"


def worker_health(settings: Settings) -> int:
    """Look for a worker on this machine that is running and able, and whose heartbeat goes on."""
    try:
        reason = _fault(settings)
    except EngineUnavailableError:
        return unhealthy("the database is not available")
    except DatabaseUnusableError as error:
        return unhealthy(str(error))
    return 0 if reason is None else unhealthy(reason)


@available
def _fault(settings: Settings) -> str | None:
    """What is wrong with the workers of this machine, None if one of them is well."""
    database = open_database(settings.system_database_url, connections=1)
    try:
        if not sa.inspect(database).has_table(WORKERS.name):
            return NOT_ALIVE
        return _fault_in(database, settings)
    finally:
        database.dispose()


def _fault_in(database: sa.Engine, settings: Settings) -> str | None:
    query = sa.select(WORKERS).where(WORKERS.c.machine == this_machine())
    watch = WorkerWatch(dead_after_s=settings.dead_after_s)
    began = time.monotonic()
    before: dict[str, int] | None = None
    while True:
        with database.connect() as connection:
            rows = connection.execute(query).all()
        alive = watch.alive(rows)
        if before is None:
            before = {row.executor_id: row.beat for row in rows}
        beaten = [
            row
            for row in rows
            if row.executor_id in alive and row.beat != before.get(row.executor_id)
        ]
        if any(row.able for row in beaten):
            return None
        if beaten and not any(row.able for row in rows if row.executor_id in alive):
            return NOT_ABLE
        if not alive or time.monotonic() - began >= settings.heartbeat_s + LATE_S:
            return NOT_ALIVE
        time.sleep(LOOK_S)
