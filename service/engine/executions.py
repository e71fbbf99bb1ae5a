"""What DBOS records about executions: who runs what, and what DBOS itself has ended."""

from collections.abc import Mapping, Sequence
from typing import Final

import sqlalchemy as sa
from dbos import DBOSClient, DBOSPortableJSONSerializer, WorkflowStatus

from service.engine.queue import APPLICATION

EXHAUSTED: Final = "MAX_RECOVERY_ATTEMPTS_EXCEEDED"
TERMINAL: Final = ("SUCCESS", "ERROR", "CANCELLED", EXHAUSTED)
OPEN: Final = ("PENDING", "ENQUEUED", "DELAYED")


class Executions:
    """Reads executions, whose ids are those of the jobs.

    An unavailable database raises ``OperationalError`` at once, where DBOS itself would wait: the
    heartbeat must not stall until the database is back.
    """

    def __init__(self, database: sa.Engine) -> None:
        self._client = DBOSClient(
            system_database_engine=database,
            serializer=DBOSPortableJSONSerializer(),
            application_name=APPLICATION,
            lazy=True,
            retry_connection_errors=False,
        )

    def holders(self) -> Mapping[str, str]:
        """By which executor, dead or alive, each job's execution is recorded as run."""
        pending = self._list(["PENDING"])
        return {
            each.workflow_id: each.executor_id for each in pending if each.executor_id is not None
        }

    def held_by(self, executor_id: str) -> set[str]:
        """The jobs whose executions are recorded as run by an executor."""
        return {each.workflow_id for each in self._list(["PENDING"], executor_id=executor_id)}

    def ended(self, job_ids: Sequence[str]) -> Mapping[str, str]:
        """Which of the jobs' executions have ended, and how: one of ``TERMINAL``."""
        # No ids would mean all executions.
        if not job_ids:
            return {}
        ended = self._list(TERMINAL, job_ids=job_ids)
        return {each.workflow_id: each.status for each in ended}

    def open(self) -> int:
        """How many executions are waiting or running."""
        return len(self._list(OPEN))

    def _list(
        self,
        status: Sequence[str],
        *,
        executor_id: str | None = None,
        job_ids: Sequence[str] | None = None,
    ) -> list[WorkflowStatus]:
        return self._client.list_workflows(
            workflow_ids=None if job_ids is None else list(job_ids),
            status=list(status),
            executor_id=executor_id,
            load_input=False,
            load_output=False,
        )
