"""``maquette health``: whether the API or a worker of this container is well.

Containers run it every few seconds, so it asks for an API without loading anything heavy.
"""

import argparse
import http.client
import json
import sys
import time
from typing import Final

from service.settings import Settings
from service.startup import run_command

TIMEOUT_S: Final = 4.0
UNHEALTHY: Final = 1
"""The only exit status that Docker takes as unhealthy."""

LATE_S: Final = 10.0
"""Delay allowed to a worker's beat beyond its interval, seconds: fits keep a machine busy. Together
with the interval this is less than docker/compose.yaml gives this command."""

LOOK_S: Final = 0.1

NOT_ALIVE: Final = "no worker of this machine is alive"
NOT_ABLE: Final = "no worker of this machine can start processes for jobs; its log says why"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Process to ask for: the API or the worker."""
    parser.add_argument("--worker", action="store_true", help="ask for the worker, not the API")


def run(parsed: argparse.Namespace) -> int:
    """Print what is wrong, and return the exit status for it."""
    return run_command("health", worker_health if parsed.worker else api_health)


def api_health(settings: Settings) -> int:
    """Ask the API of these settings whether it is ready."""
    host = {"0.0.0.0": "127.0.0.1", "::": "::1"}.get(settings.host, settings.host)
    connection = http.client.HTTPConnection(host, settings.port, timeout=TIMEOUT_S)
    try:
        connection.request("GET", "/healthz/ready")
        answer = connection.getresponse()
        body = answer.read()
    except (OSError, http.client.HTTPException) as error:
        return _unhealthy(f"no answer ({type(error).__name__})")
    finally:
        connection.close()
    if answer.status != http.client.OK:
        return _unhealthy(f"{answer.status} {_code(body)}")
    return 0


def worker_health(settings: Settings) -> int:
    """Look for a worker on this machine that is running and able, and whose heartbeat goes on."""
    # Imported here: an API is asked for without them.
    import sqlalchemy as sa
    from sqlalchemy.exc import SQLAlchemyError

    from service.jobs.database import open_database
    from service.jobs.liveness import WorkerWatch, this_machine
    from service.jobs.tables import WORKERS

    query = sa.select(WORKERS).where(WORKERS.c.machine == this_machine())
    watch = WorkerWatch(dead_after_s=settings.dead_after_s)
    ends = time.monotonic() + settings.heartbeat_s + LATE_S
    before: dict[str, int] | None = None
    database = open_database(settings.system_database_url, connections=1)
    try:
        while True:
            with database.connect() as connection:
                rows = connection.execute(query).all()
            alive = watch.alive(rows)
            living = [row for row in rows if row.executor_id in alive]
            if before is None:
                before = {row.executor_id: row.beat for row in rows}
            beaten = [row for row in living if row.beat != before.get(row.executor_id)]
            if any(row.able for row in beaten):
                return 0
            if beaten and not any(row.able for row in living):
                return _unhealthy(NOT_ABLE)
            if not living or time.monotonic() >= ends:
                return _unhealthy(NOT_ALIVE)
            time.sleep(LOOK_S)
    except SQLAlchemyError:
        return _unhealthy("the database is not available")
    finally:
        database.dispose()


def _unhealthy(reason: str) -> int:
    print(f"maquette health: {reason}", file=sys.stderr)
    return UNHEALTHY


def _code(body: bytes) -> str:
    """The code of a problem, or an empty string if it is not one of ours."""
    try:
        return str(json.loads(body)["code"])
    except (ValueError, LookupError, TypeError):
        return ""
