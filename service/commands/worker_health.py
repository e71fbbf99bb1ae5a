"""``maquette health --worker``: the health check of a worker's container."""

import time
from typing import Final

import sqlalchemy as sa

from service.commands.api_health import unhealthy
from service.engine.availability import available
from service.engine.database import open_database
from service.engine.liveness import WorkerWatch, this_machine
from service.engine.port import DatabaseUnusableError, EngineUnavailableError
from service.engine.tables import WORKERS
from service.settings import Settings

LATE_S: Final = 10.0
"""How much later than its interval a beat may come: fits keep a machine busy. Together with the
interval this is less than docker/compose.yaml gives this command."""

LOOK_S: Final = 0.1


def worker_health(settings: Settings) -> int:
    """Look for a worker on this machine that is running and whose heartbeat goes on."""
    try:
        beating = _beating(settings)
    except EngineUnavailableError:
        return unhealthy("the database is not available")
    except DatabaseUnusableError as error:
        return unhealthy(str(error))
    return 0 if beating else unhealthy("no worker of this machine is alive")


@available
def _beating(settings: Settings) -> bool:
    database = open_database(settings.system_database_url, connections=1)
    if not sa.inspect(database).has_table(WORKERS.name):
        return False
    query = sa.select(WORKERS).where(WORKERS.c.machine == this_machine())
    watch = WorkerWatch(dead_after_s=settings.dead_after_s)
    began = time.monotonic()
    before: dict[str, int] | None = None
    try:
        while True:
            with database.connect() as connection:
                rows = connection.execute(query).all()
            alive = watch.alive(rows)
            if before is None:
                before = {row.executor_id: row.beat for row in rows}
            elif any(
                row.executor_id in alive and row.beat != before.get(row.executor_id) for row in rows
            ):
                return True
            if not alive or time.monotonic() - began >= settings.heartbeat_s + LATE_S:
                return False
            time.sleep(LOOK_S)
    finally:
        database.dispose()
