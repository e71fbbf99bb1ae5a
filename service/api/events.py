"""A fit's events as they happen: server-sent events, resumable."""

import asyncio
import time
from collections.abc import AsyncIterator
from typing import Annotated, Any, Final

from fastapi import Header, Response
from fastapi.responses import StreamingResponse
from fastapi.sse import KEEPALIVE_COMMENT, format_sse_event
from starlette.concurrency import run_in_threadpool

from api_schemas.jobs import EventData, EventKind
from service.api.context import ApiContext
from service.jobs.engine import TenantJobs
from service.jobs.records import TERMINAL, EngineUnavailableError, JobEvent, JobRecord

PING_S: Final = 15.0
AWAY_PAUSE_S: Final = 1.0
RECONNECT_MS: Final = 1_000

LastEventId = Annotated[int | None, Header(ge=0, description="Resume after this event.")]

ITEMS: Final = "x-itemSchema"
"""OpenAPI 3.2 has `itemSchema` for the items of a stream; in 3.1 this needs an extension."""

_STREAM: Final[dict[str, Any]] = {
    "description": "Events until the fit ends; the last one is `end`.",
    "content": {
        "text/event-stream": {
            "schema": {"type": "string"},
            ITEMS: {
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
            },
        }
    },
}

EVENT_ANSWERS: Final[dict[int | str, dict[str, Any]]] = {
    200: _STREAM,
    204: {
        "description": "The fit has ended, and there is no event after `Last-Event-ID`: an "
        "`EventSource` does not reconnect."
    },
}


def event_stream(context: ApiContext, record: JobRecord, last_event_id: int | None) -> Response:
    """Answer with the events of a fit, as they come; 204 after its end."""
    # An event number that never existed: send all that follow.
    seen = min(last_event_id or 0, record.last_event)
    if record.state in TERMINAL and seen == record.last_event:
        return Response(status_code=204)
    return StreamingResponse(
        _stream(context, context.jobs, record.id, seen),
        media_type="text/event-stream",
        headers={"Cache-Control": "no-store", "X-Accel-Buffering": "no"},
    )


async def _stream(
    context: ApiContext, jobs: TenantJobs, job_id: str, seen: int
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
        if context.feed.is_ending:
            # The client reconnects on its own, to a process that stays, and misses nothing.
            return
        await context.feed.wait_beyond(
            job_id, seen, timeout_s=max(0.0, last_sign + PING_S - time.monotonic())
        )


def _format(event: JobEvent) -> bytes:
    data: EventData = event.data
    return format_sse_event(
        data_str=data.model_dump_json(), event=event.kind.value, id=str(event.number)
    )
