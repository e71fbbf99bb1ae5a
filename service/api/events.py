"""A job's events as they happen: server-sent events, resumable."""

import time
from collections.abc import AsyncIterator
from typing import Annotated, Any, Final
from uuid import UUID

from fastapi import APIRouter, Header
from fastapi.responses import StreamingResponse
from fastapi.sse import KEEPALIVE_COMMENT, format_sse_event
from starlette.concurrency import run_in_threadpool

from api_schemas.jobs import EventData, EventKind
from service.api.context import ApiContext, Context
from service.api.job_routes import JOB_PROBLEMS, find
from service.api.problems import documented
from service.engine.port import JobEvent, TenantJobs

ROUTER: Final = APIRouter(prefix="/v1/fits", tags=["fits"])

PING_S: Final = 15.0
RECONNECT_MS: Final = 1_000

LastEventId = Annotated[int | None, Header(ge=0, description="Resume after this event.")]

STREAM: Final[dict[str, Any]] = {
    "description": "Events until the job ends; the last one is `end`.",
    "content": {
        "text/event-stream": {
            "itemSchema": {
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
        }
    },
}


@ROUTER.get(
    "/{fit_id}/events",
    summary="Follow a job",
    response_class=StreamingResponse,
    responses={200: STREAM} | documented(*JOB_PROBLEMS),
)
def follow(fit_id: UUID, context: Context, last_event_id: LastEventId = None) -> StreamingResponse:
    """Stream state changes, stages, progress and energies.

    All events since the job was accepted are kept: whoever comes late or reconnects misses none.
    """
    return event_stream(context, context.jobs, fit_id, last_event_id)


def event_stream(
    context: ApiContext, jobs: TenantJobs, job_id: UUID, last_event_id: int | None
) -> StreamingResponse:
    """Answer with the events of a job, as they come; 404 if there is no such job."""
    find(jobs, job_id)
    return StreamingResponse(
        _stream(context, jobs, str(job_id), last_event_id or 0),
        media_type="text/event-stream",
        headers={"Cache-Control": "no-store", "X-Accel-Buffering": "no"},
    )


async def _stream(
    context: ApiContext, jobs: TenantJobs, job_id: str, seen: int
) -> AsyncIterator[bytes]:
    yield format_sse_event(retry=RECONNECT_MS)
    last_sign = time.monotonic()
    while True:
        for event in await run_in_threadpool(jobs.events, job_id, after=seen):
            yield _format(event)
            seen = event.number
            last_sign = time.monotonic()
            if event.kind is EventKind.END:
                return
        if context.feed.is_ending:
            # The listener comes back by itself, to a process that stays, and misses nothing.
            return
        await context.feed.wait_beyond(
            job_id, seen, timeout_s=max(0.0, last_sign + PING_S - time.monotonic())
        )
        if time.monotonic() >= last_sign + PING_S:
            if await run_in_threadpool(jobs.job, job_id) is None:
                return
            yield KEEPALIVE_COMMENT
            last_sign = time.monotonic()


def _format(event: JobEvent) -> bytes:
    data: EventData = event.data
    return format_sse_event(
        data_str=data.model_dump_json(), event=event.kind.value, id=str(event.number)
    )
