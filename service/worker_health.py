"""``maquette health --worker``: what a container of a worker is asked."""

import time

import sqlalchemy as sa

from service.api_health import unhealthy
from service.engine.availability import available
from service.engine.database import DatabaseUnusableError, open_database
from service.engine.liveness import WorkerWatch, this_machine
from service.engine.port import EngineUnavailableError
from service.engine.tables import WORKERS
from service.settings import Settings


def worker_health(settings: Settings) -> int:
    """Look for a worker of this machine that runs and whose heart beats."""
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
    with database.connect() as connection:
        before = {row.executor_id: row.beat for row in connection.execute(query)}
    time.sleep(1.5 * settings.heartbeat_s)
    with database.connect() as connection:
        rows = connection.execute(query).all()
    database.dispose()
    alive = watch.alive(rows)
    return any(row.executor_id in alive and row.beat != before.get(row.executor_id) for row in rows)
