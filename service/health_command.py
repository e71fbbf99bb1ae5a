"""``maquette health``: what a container's health check asks."""

import sys
import time
from typing import Final

import httpx
import sqlalchemy as sa

from service.engine.availability import available
from service.engine.database import open_database
from service.engine.liveness import WorkerWatch, this_machine
from service.engine.tables import WORKERS
from service.settings import Settings

TIMEOUT_S: Final = 4.0
UNHEALTHY: Final = 1


def api_health(settings: Settings) -> int:
    """Ask the API of these settings whether it is ready."""
    host = {"0.0.0.0": "127.0.0.1", "::": "::1"}.get(settings.host, settings.host)
    address = f"[{host}]" if ":" in host else host
    try:
        answer = httpx.get(f"http://{address}:{settings.port}/healthz/ready", timeout=TIMEOUT_S)
    except httpx.TransportError as error:
        return _unhealthy(f"no answer ({type(error).__name__})")
    if answer.status_code != httpx.codes.OK:
        return _unhealthy(f"{answer.status_code} {answer.json().get('code', '')}")
    return 0


@available
def worker_health(settings: Settings) -> int:
    """Look for a worker of this machine that runs and whose heart beats."""
    database = open_database(settings.system_database_url, connections=1)
    query = sa.select(WORKERS).where(WORKERS.c.machine == this_machine())
    watch = WorkerWatch(dead_after_s=settings.dead_after_s)
    with database.connect() as connection:
        before = {row.executor_id: row.beat for row in connection.execute(query)}
    time.sleep(1.5 * settings.heartbeat_s)
    with database.connect() as connection:
        rows = connection.execute(query).all()
    database.dispose()
    alive = watch.alive(rows)
    if any(row.executor_id in alive and row.beat != before.get(row.executor_id) for row in rows):
        return 0
    return _unhealthy("no worker of this machine is alive")


def _unhealthy(reason: str) -> int:
    print(f"maquette health: {reason}", file=sys.stderr)
    return UNHEALTHY
