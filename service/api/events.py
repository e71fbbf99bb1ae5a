"""The events of fits: a feed that wakes who waits, streams of events, and waits for the end."""

import asyncio
import logging
import re
import threading
import time
from collections import Counter
from collections.abc import AsyncIterator, Callable, Iterator
from contextlib import contextmanager
from typing import Annotated, Any, Final

from fastapi import Header, Response
from fastapi.responses import StreamingResponse
from fastapi.sse import KEEPALIVE_COMMENT, format_sse_event
from starlette.concurrency import run_in_threadpool

from api_schemas.jobs import EventData, EventKind
from service.api.problems import ProblemError, not_found, problem_error
from service.jobs.engine import JobEngine, TenantJobs
from service.jobs.records import ACTIVE, TERMINAL, EngineUnavailableError, JobEvent, JobRecord

LOG: Final = logging.getLogger(__name__)

POLL_S: Final = 0.1
PAUSE_AFTER_FAILURE_S: Final = 1.0
GONE: Final = -1
"""Stands for the last event of a job that no longer exists."""

PING_S: Final = 15.0
AWAY_PAUSE_S: Final = 1.0
RECONNECT_MS: Final = 1_000
MAX_WAIT_S: Final = 60

OWNERS_SHARE: Final = 100
"""The most streams and waits of one owner at a time in a process."""

LastEventId = Annotated[int | None, Header(ge=0, description="Resume after this event.")]
Prefer = Annotated[str | None, Header(description="`respond-async` or `wait=N`.")]

_EVENT: Final = {
    "type": "object",
    "required": ["event", "data", "id"],
    "properties": {
        "event": {"type": "string", "enum": [kind.value for kind in EventKind]},
        "data": {
            "type": "string",
            "contentMediaType": "application/json",
            "contentSchema": {"$ref": "#/components/schemas/EventData"},
        },
        "id": {"type": "string"},
        "retry": {"type": "integer"},
    },
}
EVENT_ANSWERS: Final[dict[int | str, dict[str, Any]]] = {
    200: {
        "description": "Events until the fit ends: its last `state`, and `end`, which repeats it.",
        "content": {
            "text/event-stream": {
                "schema": {
                    "type": "string",
                    "contentMediaType": "text/event-stream",
                    "contentSchema": {"type": "array", "items": _EVENT},
                }
            }
        },
    },
    204: {
        "description": "The fit has ended, and there is no event after `Last-Event-ID`: an "
        "`EventSource` does not reconnect."
    },
}


class EventFeed:
    """Follows the last event number of every job that someone waits for: one query for all."""

    def __init__(
        self, engine: JobEngine, draining: threading.Event, *, owners_share: int = OWNERS_SHARE
    ) -> None:
        self._engine = engine
        self._draining = draining
        self._owners_share = owners_share
        self._followed: Counter[str] = Counter()
        self._waiting: Counter[str] = Counter()
        self._last: dict[str, int] = {}
        self._changed = asyncio.Condition()

    @contextmanager
    def place(self, owner: str) -> Iterator[bool]:
        """Take one of the owner's places while something is followed; False if none is free."""
        has_place = self._followed[owner] < self._owners_share
        self._followed[owner] += has_place
        try:
            yield has_place
        finally:
            self._followed[owner] -= has_place
            self._followed += Counter[str]()

    async def wait_beyond(self, job_id: str, number: int, *, timeout_s: float) -> None:
        """Return when the job has an event numbered above ``number``, is gone, or time is up.

        Returns at once if the process is being stopped.
        """
        self._waiting[job_id] += 1
        try:
            async with asyncio.timeout(timeout_s), self._changed:
                await self._changed.wait_for(
                    lambda: self.is_ending or self._last.get(job_id, number) != number
                )
        except TimeoutError:
            return
        finally:
            self._waiting[job_id] -= 1
            if self._waiting[job_id] <= 0:
                del self._waiting[job_id]
                self._last.pop(job_id, None)

    @property
    def is_ending(self) -> bool:
        """True once the process is stopping: clients that follow a job should ask another one."""
        return self._draining.is_set()

    async def run(self) -> None:
        """Poll until canceled; idle while nobody waits."""
        while True:
            await asyncio.sleep(POLL_S)
            if self.is_ending:
                async with self._changed:
                    self._changed.notify_all()
                continue
            waiting = list(self._waiting)
            if not waiting:
                continue
            try:
                numbers = await run_in_threadpool(self._engine.last_events, waiting)
            except Exception as error:
                # Waiting requests run into their timeouts and query the database themselves.
                if isinstance(error, EngineUnavailableError):
                    LOG.warning("The database is not available; events are told later.")
                else:
                    LOG.exception("Looking for events failed.")
                await asyncio.sleep(PAUSE_AFTER_FAILURE_S)
                continue
            latest = {job_id: numbers.get(job_id, GONE) for job_id in waiting}
            if latest.items() - self._last.items():
                self._last |= latest
                async with self._changed:
                    self._changed.notify_all()


def event_stream(
    feed: EventFeed, jobs: TenantJobs, record: JobRecord, last_event_id: int | None
) -> Response:
    """Answer with the events of a fit, as they come; 204 after its end."""
    # An event number that never existed: send all that follow.
    seen = min(last_event_id or 0, record.last_event)
    if record.state in TERMINAL and seen == record.last_event:
        return Response(status_code=204)
    return StreamingResponse(
        _stream(feed, jobs, record.id, seen),
        media_type="text/event-stream",
        headers={"Cache-Control": "no-store", "X-Accel-Buffering": "no"},
    )


def too_many_streams() -> ProblemError:
    """Say that the owner has no place to follow one more."""
    return problem_error(
        slug="too-many-requests",
        code="too-many-streams",
        detail="Too many of your fits are followed already.",
        remedy="Follow fewer fits at a time, or look at them now and then.",
    )


async def _stream(
    feed: EventFeed, jobs: TenantJobs, job_id: str, seen: int
) -> AsyncIterator[bytes]:
    yield format_sse_event(retry=RECONNECT_MS)
    last_sign = time.monotonic()
    while True:
        is_silent = time.monotonic() >= last_sign + PING_S
        try:
            events = await run_in_threadpool(jobs.events, job_id, after=seen)
            if is_silent and not events and await run_in_threadpool(jobs.job, job_id) is None:
                return
        except EngineUnavailableError:
            # An `EventSource` whose stream ended now would reconnect, get 503 and give up for good.
            events = ()
            await asyncio.sleep(AWAY_PAUSE_S)
        for event in events:
            yield _format(event)
            seen = event.number
            if event.kind is EventKind.END:
                return
        if is_silent and not events:
            yield KEEPALIVE_COMMENT
        if is_silent or events:
            last_sign = time.monotonic()
        if feed.is_ending:
            # The client reconnects on its own, to a process that stays, and misses nothing.
            return
        await feed.wait_beyond(
            job_id, seen, timeout_s=max(0.0, last_sign + PING_S - time.monotonic())
        )


def _format(event: JobEvent) -> bytes:
    data: EventData = event.data
    return format_sse_event(
        data_str=data.model_dump_json(), event=event.kind.value, id=str(event.number)
    )


def preferred_wait_s(prefer: str | None) -> int:
    """Return how long the caller prefers to wait for the end."""
    found = re.search(r"(?:^|[,;\s])wait\s*=\s*(\d{1,6})", prefer or "")
    return min(int(found[1]), MAX_WAIT_S) if found else 0


async def wait_for_end(
    feed: EventFeed,
    owner: str,
    job: JobRecord,
    look: Callable[[], JobRecord | None],
    *,
    prefer: str | None,
    response: Response,
) -> JobRecord:
    """Wait for the end of a job as long as the caller prefers, where its owner has a place.

    ``look`` looks at the job. Returns it in its state by then; ``response`` says that it was waited
    for.
    """
    wait_s = preferred_wait_s(prefer)
    deadline = time.monotonic() + wait_s
    with feed.place(owner) as has_place:
        if not (wait_s and has_place):
            return job
        response.headers["Preference-Applied"] = f"wait={wait_s}"
        while (
            job.state in ACTIVE
            and not feed.is_ending
            and (remaining_s := deadline - time.monotonic()) > 0
        ):
            await feed.wait_beyond(job.id, job.last_event, timeout_s=remaining_s)
            latest = await run_in_threadpool(look)
            if latest is None:
                raise not_found(what="such fit any more")
            job = latest
    return job
