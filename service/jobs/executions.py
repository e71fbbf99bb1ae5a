"""DBOS's records of executions: who runs what, and how it ended. Their ids are the jobs'."""

from collections.abc import Mapping
from typing import Final

import sqlalchemy as sa
from dbos import DBOS, DBOSClient, DBOSPortableJSONSerializer

APPLICATION: Final = "maquette"
WORKFLOW: Final = "fit"
EXECUTION_VERSION: Final = "1"
"""DBOS's application version: that of the checkpoints' meaning, not of the code. Raised only when
stored checkpoints can no longer be continued; workers run only jobs of their own version."""

FAILED: Final = "ERROR"
ENDED: Final = ("SUCCESS", FAILED, "CANCELLED", "MAX_RECOVERY_ATTEMPTS_EXCEEDED")

CONTINUE_S: Final = 0.5
"""Interval at which DBOS looks for executions that a worker is to continue, seconds."""


def client_of(database: sa.Engine) -> DBOSClient:
    """A client of DBOS that raises ``OperationalError`` at once while the database is away.

    DBOS itself would wait: a request is to be refused, and a heartbeat must not stall.
    """
    return DBOSClient(
        system_database_engine=database,
        serializer=DBOSPortableJSONSerializer(),
        application_name=APPLICATION,
        lazy=True,
        retry_connection_errors=False,
    )


def configure(database: sa.Engine, *, executor_id: str, log_level: str) -> None:
    """Set DBOS up in this process; it is launched once its workflows are registered."""
    DBOS(
        config={
            "name": APPLICATION,
            "system_database_engine": database,
            "serializer": DBOSPortableJSONSerializer(),
            "executor_id": executor_id,
            "application_version": EXECUTION_VERSION,
            "run_migrations": False,
            "log_level": log_level,
        }
    )


def queue_of(executor_id: str) -> str:
    """Name the queue on which a worker continues executions that others have begun."""
    return f"fits-{executor_id}"


def holders(client: DBOSClient) -> Mapping[str, str]:
    """By which executor, dead or alive, each job's execution is recorded as run."""
    pending = client.list_workflows(
        name=WORKFLOW, status="PENDING", load_input=False, load_output=False
    )
    return {each.workflow_id: each.executor_id for each in pending if each.executor_id is not None}


def ending(client: DBOSClient, job_id: str) -> str | None:
    """The end of a job's execution: one of ``ENDED``; None if it has not ended."""
    found = client.list_workflows(
        workflow_ids=[job_id],
        name=WORKFLOW,
        status=list(ENDED),
        load_input=False,
        load_output=False,
    )
    return found[0].status if found else None
