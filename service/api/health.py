"""Is the process alive, can it do its work, and its figures for Prometheus.

The first two are answered by the event loop itself, which no other request can keep waiting. A
check of a database or a storage that does not answer takes a minute or more. Checks therefore run
one at a time in a thread of their own, and probes are answered meanwhile.
"""

import asyncio
import contextlib
import threading
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Final

from fastapi import APIRouter, Request, Response
from prometheus_client.exposition import CONTENT_TYPE_LATEST

from api_schemas.service import Health
from service.api.context import Context, Parts
from service.api.problems import ProblemError, problem_error
from service.jobs.blobs import WatchedBlobs
from service.jobs.engine import JobEngine
from service.jobs.records import WorkerStatus
from service.process.data_folder import Disk

ROUTER: Final = APIRouter(tags=["health"])

ANSWER_WITHIN_S: Final = 1.5
"""The time limit of a look; probes wait for two seconds and more."""

SILENT: Final = {
    "database": ("database-unavailable", "The database has not answered for {seconds:.0f} s."),
    "storage": ("storage-unavailable", "The storage has not answered for {seconds:.0f} s."),
}


@ROUTER.get("/healthz/live", response_model=Health, summary="The process answers")
async def get_liveness() -> Health:
    """Answer."""
    return Health(status="live")


@ROUTER.get(
    "/healthz/ready",
    response_model=Health,
    summary="A fit can be accepted and finished",
)
async def get_readiness(request: Request) -> Health:
    """Check that database and storage can be written and a worker is alive and able to work.

    Answered within two seconds: a database or a storage that says nothing for so long is not
    available. Probes that come at the same time share one check.

    A worker is able once it has started a process for jobs, and until it cannot start any more:
    seconds after its start, or minutes where it compiles its numerics first. 503 also while this
    process is being stopped.
    """
    parts: Parts = request.app.state.parts
    if parts.draining.is_set():
        raise not_ready(code="draining", detail="This process is being stopped.")
    readiness: Readiness = request.app.state.readiness
    return await readiness.ready()


@ROUTER.get(
    "/metrics",
    summary="Figures for Prometheus",
    response_class=Response,
    responses={
        200: {
            "description": "Prometheus' text format.",
            "content": {"text/plain": {"schema": {"type": "string"}}},
        }
    },
)
def get_metrics(context: Context) -> Response:
    """Return queue, workers, endings, durations and requests, for keys of the tenant `metrics`."""
    return Response(context.metrics.exposition(), media_type=CONTENT_TYPE_LATEST)


@dataclass(slots=True)
class Look:
    """One look at everything; ``at`` is what it waits for."""

    began: float
    at: str = "database"
    answer: asyncio.Future[Health] = field(default_factory=asyncio.Future[Health])


class Readiness:
    """Answers probes; used by one event loop."""

    def __init__(
        self,
        check: Callable[[Look], Health],
        *,
        answer_within_s: float = ANSWER_WITHIN_S,
        monotonic: Callable[[], float] = time.monotonic,
    ) -> None:
        self._check = check
        self._answer_within_s = answer_within_s
        self._monotonic = monotonic
        self.last: Look | None = None
        """The look that is being made, or was made last."""

    async def ready(self) -> Health:
        """Return within two seconds, whatever database and storage do.

        Raises
        ------
        ProblemError
            If a part is missing, or does not answer.
        EngineUnavailableError
            If the database is not available.
        BlobsUnavailableError
            If the storage is not available.
        """
        look = self._current()
        left_s = self._answer_within_s - (self._monotonic() - look.began)
        await asyncio.wait([look.answer], timeout=max(left_s, 0.0))
        if look.answer.done():
            return look.answer.result()
        code, detail = SILENT[look.at]
        raise not_ready(
            code=code, detail=detail.format(seconds=max(self._monotonic() - look.began, 1.0))
        )

    def _current(self) -> Look:
        """The look that is being made, or a new one."""
        if self.last is not None and not self.last.answer.done():
            return self.last
        self.last = Look(began=self._monotonic())
        threading.Thread(
            target=self._make,
            args=(self.last, asyncio.get_running_loop()),
            name="readiness",
            daemon=True,
        ).start()
        return self.last

    def _make(self, look: Look, loop: asyncio.AbstractEventLoop) -> None:
        try:
            outcome: Health | Exception = self._check(look)
        except Exception as error:
            outcome = error
        # Nobody asks any more once the loop is closed.
        with contextlib.suppress(RuntimeError):
            loop.call_soon_threadsafe(self._end, look, outcome)

    def _end(self, look: Look, outcome: Health | Exception) -> None:
        if isinstance(outcome, Exception):
            look.answer.set_exception(outcome)
            # Read here, so that an answer nobody waits for any more is not logged as forgotten.
            look.answer.exception()
        else:
            look.answer.set_result(outcome)


def checks(engine: JobEngine, blobs: WatchedBlobs, disk: Disk) -> Callable[[Look], Health]:
    """Build a look at disk, database, storage and workers."""

    def check(look: Look) -> Health:
        # First: a database on a full disk cannot be written, and would be reported as unavailable.
        if not disk.has_room_for():
            raise not_ready(code="disk-full", detail="The disk of the data folder is nearly full.")
        engine.check_writable()
        look.at = "storage"
        blobs.check_writable()
        look.at = "database"
        workers = engine.workers()
        able = sum(worker.is_ready for worker in workers)
        if able == 0:
            raise not_ready(code="no-worker", detail=_why_none(workers))
        return Health(status="ready", workers=able, queued=engine.queued())

    return check


def _why_none(workers: Sequence[WorkerStatus]) -> str:
    if not any(worker.alive for worker in workers):
        return "No worker is alive."
    return "No worker can begin a job: it is still loading, or its log says what is wrong."


def not_ready(*, code: str, detail: str) -> ProblemError:
    """Say what is missing."""
    return problem_error(
        slug="not-ready", code=code, detail=detail, remedy="Try again in a moment."
    )
