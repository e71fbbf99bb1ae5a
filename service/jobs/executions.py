"""What DBOS records of executions: who runs what, and how it ended. Their ids are the jobs'."""

from collections.abc import Collection, Mapping, Sequence
from typing import Final

import sqlalchemy as sa
from dbos import DBOS, DBOSClient, DBOSPortableJSONSerializer, WorkflowStatus

APPLICATION: Final = "maquette"
WORKFLOW: Final = "fit"
EXECUTION_VERSION: Final = "1"
"""DBOS's application version: that of the checkpoints' meaning, not of the code. Raised only when
stored checkpoints can no longer be continued; workers run only jobs of their own version."""

FAILED: Final = "ERROR"
ENDED: Final = ("SUCCESS", FAILED, "CANCELLED", "MAX_RECOVERY_ATTEMPTS_EXCEEDED")

CONTINUE_S: Final = 0.5
"""How often DBOS looks for executions that a worker is to continue."""


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


class Executions:
    """Reads executions, and removes those that are over."""

    def __init__(self, client: DBOSClient) -> None:
        self._client = client

    def holders(self) -> Mapping[str, str]:
        """By which executor, dead or alive, each job's execution is recorded as run."""
        return {
            each.workflow_id: each.executor_id
            for each in self._list(["PENDING"])
            if each.executor_id is not None
        }

    def ending(self, job_id: str) -> str | None:
        """How a job's execution ended: one of ``ENDED``; None if it has not."""
        found = self._list(ENDED, job_id=job_id)
        return found[0].status if found else None

    def remove(self, job_ids: Collection[str]) -> None:
        """Forget executions, with their checkpoints."""
        self._client.delete_workflows(list(job_ids))

    def declare_queue(self, executor_id: str) -> None:
        """Make the queue on which an executor continues what others have begun."""
        self._client.register_queue(queue_of(executor_id), polling_interval_sec=CONTINUE_S)

    def drop_queue(self, executor_id: str) -> None:
        """Remove the queue of an executor that is gone."""
        self._client.delete_queue(queue_of(executor_id))

    def _list(self, status: Sequence[str], *, job_id: str | None = None) -> list[WorkflowStatus]:
        return self._client.list_workflows(
            workflow_ids=None if job_id is None else [job_id],
            name=WORKFLOW,
            status=list(status),
            load_input=False,
            load_output=False,
        )
