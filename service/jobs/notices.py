"""Notices of jobs' ends: each a workflow of DBOS, whose one step sends it and is retried by DBOS.

A notice is enqueued in the transaction that ends its job, under an id made of the job's, so none is
lost and none is there twice. API processes send them. One that dies leaves its notices to the next
API process of its machine; those of a machine that is gone are enqueued again by the sweep.
"""

import asyncio
import logging
import os
from collections.abc import Awaitable, Callable
from datetime import UTC, datetime, timedelta
from typing import Final

import sqlalchemy as sa
from dbos import DBOS, DBOSClient, DBOSPortableJSONSerializer, error

from service.jobs.executions import APPLICATION, EXECUTION_VERSION
from service.jobs.port import JobRecord
from service.jobs.records import find_job
from service.process.logs import fields

LOG: Final = logging.getLogger(__name__)

QUEUE: Final = "notices"
WORKFLOW: Final = "notice"

POLL_S: Final = 0.5
FIRST_PAUSE_S: Final = 1.0
LONGER_BY: Final = 4.0
ATTEMPTS: Final = 8
"""With pauses of 1, 4, 16 ... seconds, none longer than an hour: the last attempt is 83 minutes
after the first."""

LEFT_AFTER: Final = timedelta(hours=3)
"""By then a notice has been accepted or given up, unless whoever sent it is gone."""


def notice_of(job_id: str) -> str:
    """The id of the workflow that tells of a job's end."""
    return f"{WORKFLOW}-{job_id}"


class Notices:
    """Enqueues notices, and forgets them with their jobs."""

    def __init__(self, database: sa.Engine) -> None:
        self._client = DBOSClient(
            system_database_engine=database,
            serializer=DBOSPortableJSONSerializer(),
            application_name=APPLICATION,
            lazy=True,
            retry_connection_errors=False,
        )

    def enqueue(self, connection: sa.Connection, job: JobRecord) -> None:
        """Have the end of a job told, in the transaction that ends it, if anybody asked for it."""
        if job.webhook is not None:
            self._client.enqueue_in_transaction(
                connection,
                {
                    "workflow_name": WORKFLOW,
                    "queue_name": QUEUE,
                    "workflow_id": notice_of(job.id),
                    "app_version": EXECUTION_VERSION,
                },
                job.id,
            )

    def enqueue_left(self) -> None:
        """Enqueue again what processes that are gone have left."""
        latest = (datetime.now(UTC) - LEFT_AFTER).isoformat()
        left = self._client.list_workflows(
            name=WORKFLOW, status="PENDING", end_time=latest, load_input=False, load_output=False
        )
        for each in left:
            self._client.resume_workflow(each.workflow_id, queue_name=QUEUE)

    def declare_queue(self) -> None:
        """Make the queue, of which every API process takes."""
        self._client.register_queue(QUEUE, polling_interval_sec=POLL_S)


class NoticeRunner:
    """Runs the workflows in an API process; ``send`` raises where a notice is not accepted."""

    def __init__(self, database: sa.Engine, send: Callable[[JobRecord], Awaitable[None]]) -> None:
        self._database = database
        self._send = send

    def start(self) -> None:
        """Begin to send what is enqueued, and what this machine's last process left."""
        DBOS(
            config={
                "name": APPLICATION,
                "system_database_engine": self._database,
                "serializer": DBOSPortableJSONSerializer(),
                "executor_id": f"notices-{os.uname().nodename[:40]}",
                "application_version": EXECUTION_VERSION,
                "run_migrations": False,
                # What is retried is a warning of its own.
                "log_level": "ERROR",
            }
        )
        self._register()
        DBOS.listen_queues([QUEUE])
        Notices(self._database).declare_queue()
        DBOS.launch()

    def stop(self) -> None:
        """Stop; what is under way is sent again."""
        DBOS.destroy()

    def _register(self) -> None:
        @DBOS.step(
            name="send",
            retries_allowed=True,
            interval_seconds=FIRST_PAUSE_S,
            backoff_rate=LONGER_BY,
            max_attempts=ATTEMPTS,
        )
        async def send(job_id: str) -> None:
            job = await asyncio.to_thread(self._find, job_id)
            if job is not None:
                await self._send(job)

        @DBOS.workflow(name=WORKFLOW)
        async def notice(job_id: str) -> None:
            try:
                await send(job_id)
            except error.DBOSMaxStepRetriesExceeded:
                LOG.warning("A notice was given up.", extra=fields(job=job_id))

        self._workflow = notice

    def _find(self, job_id: str) -> JobRecord | None:
        with self._database.connect() as connection:
            return find_job(connection, job_id)
