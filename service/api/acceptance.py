"""From checked inputs to an accepted fit: store its blobs, write its record, await its end."""

import hashlib
import re
import time
from collections.abc import Awaitable, Callable
from functools import partial
from typing import Annotated, Any, Final
from uuid import uuid4

from fastapi import Header, Response
from starlette.concurrency import run_in_threadpool

from api_schemas.jobs import Fit
from api_schemas.problems import problem
from service.api.context import ApiContext
from service.api.fit_inputs import Inputs, store_inputs
from service.api.problems import ProblemError, not_found
from service.api.storage import disk_full, erase_at_once, storing
from service.jobs.records import (
    ACTIVE,
    FIT,
    Idempotency,
    JobRecord,
    NewJob,
    Submission,
    SubmitOutcome,
)
from service.representation.jobs import POLL_AFTER_S, fit_path

MAX_WAIT_S: Final = 60


def accepted() -> dict[int | str, dict[str, Any]]:
    """Describe the answers to an accepted fit, for the OpenAPI document."""
    return {
        200: {"model": Fit, "description": "Ended within the time of `Prefer: wait`."},
        202: {
            "description": "Accepted.",
            "headers": {
                "Location": {"description": "Path of the fit.", "schema": {"type": "string"}},
                "Retry-After": {"description": "Seconds to wait.", "schema": {"type": "integer"}},
            },
        },
    }


ACCEPTANCE_PROBLEMS: Final = (
    "idempotency-key-reused",
    "invalid-request",
    "too-many-requests",
    "queue-full",
    "insufficient-storage",
    "not-ready",
    "internal-error",
)
"""Problems that may keep checked inputs from being accepted."""


IdempotencyKey = Annotated[
    str | None,
    Header(
        min_length=1,
        max_length=255,
        description="The same key with the same content answers with the earlier job.",
    ),
]
Prefer = Annotated[str | None, Header(description="`respond-async` or `wait=N`.")]


async def accept(
    context: ApiContext,
    inputs: Inputs,
    *,
    key: Idempotency | None,
    check: Callable[[], Awaitable[None]] | None = None,
) -> JobRecord:
    """Have a fit accepted, or return the earlier one with the same key.

    ``check`` runs only if a new fit is about to be accepted.

    Raises
    ------
    ProblemError
        If the fit is not accepted.
    """
    fit_id = str(uuid4())
    with storing():
        # From here on the fit's scope is erased automatically unless the fit is accepted.
        submission = await run_in_threadpool(_reserve, context, fit_id, inputs, key)
        if submission.outcome is SubmitOutcome.ACCEPTED:
            if check is not None:
                await check()
            submission = await run_in_threadpool(_store, context, fit_id, inputs, key)
    return accepted_job(submission)


def idempotency(key: str | None, *parts: bytes) -> Idempotency | None:
    """Hash a caller's key and the parts of the request that came with it."""
    if key is None:
        return None
    digest = hashlib.sha256()
    for part in parts:
        digest.update(hashlib.sha256(part).digest())
    return Idempotency(key=hashlib.sha256(key.encode()).hexdigest(), fingerprint=digest.hexdigest())


async def answer(
    context: ApiContext, response: Response, fit: JobRecord, *, prefer: str | None
) -> JobRecord:
    """Complete the answer about an accepted fit, after its end if the caller prefers to wait.

    Returns the fit in its state by then.
    """
    wait_s = preferred_wait_s(prefer)
    if wait_s > 0:
        look = partial(context.jobs.job, fit.id)
        fit = await wait_for_end(context, fit, look, wait_s=wait_s)
        response.headers["Preference-Applied"] = f"wait={wait_s}"
    response.headers["Location"] = fit_path(fit.id)
    if fit.state in ACTIVE:
        response.headers["Retry-After"] = str(POLL_AFTER_S)
    elif wait_s > 0:
        response.status_code = 200
    return fit


def _reserve(
    context: ApiContext, fit_id: str, inputs: Inputs, key: Idempotency | None
) -> Submission:
    if context.disk.has_room_for(inputs.size):
        return context.jobs.submissions.reserve(fit_id, key)
    # Not even the scope is recorded; but repeating an earlier answer takes no space.
    repeated = context.jobs.submissions.repeated(key)
    if repeated is None:
        raise disk_full()
    return repeated


def _store(context: ApiContext, fit_id: str, inputs: Inputs, key: Idempotency | None) -> Submission:
    stored = store_inputs(context, fit_id, inputs)
    job = NewJob(
        id=fit_id,
        kind=FIT,
        options=stored.options,
        inputs=stored.files,
        pictures=inputs.pictures,
        label=inputs.label,
        idempotency=key,
        request_id=context.request_id,
        webhook=stored.webhook,
    )
    # If the database goes away before it answers, it may have accepted the job: the blobs stay.
    submission = context.jobs.submissions.submit(job)
    if submission.outcome is not SubmitOutcome.ACCEPTED:
        erase_at_once(context.blobs, fit_id)
    return submission


def accepted_job(submission: Submission) -> JobRecord:
    """Return the job that was accepted, now or earlier.

    Raises
    ------
    ProblemError
        If none was.
    """
    if submission.outcome is SubmitOutcome.QUEUE_FULL:
        raise ProblemError(
            problem(
                "queue-full",
                detail="The queue of waiting jobs is full.",
                remedy="Try again after the time in Retry-After.",
            )
        )
    if submission.outcome is SubmitOutcome.TENANT_FULL:
        raise ProblemError(
            problem(
                "too-many-requests",
                code="too-many-waiting",
                detail="Too many of your jobs are waiting already.",
                remedy="Try again when some of them have ended.",
            )
        )
    if submission.outcome is SubmitOutcome.LOST:
        raise ProblemError(
            problem(
                "not-ready",
                code="submission-lost",
                detail="The upload took too long and was given up.",
                remedy="Post it again.",
            )
        )
    if submission.outcome is SubmitOutcome.FIT_GONE:
        raise not_found(what="such fit any more")
    if submission.job is None:
        raise ProblemError(
            problem(
                "idempotency-key-reused",
                detail="This Idempotency-Key came earlier with another request.",
                remedy="Use a new key for every new request.",
                field="Idempotency-Key",
            )
        )
    return submission.job


def preferred_wait_s(prefer: str | None) -> int:
    """Return how long the caller prefers to wait for the end."""
    found = re.search(r"(?:^|[,;\s])wait\s*=\s*(\d{1,6})", prefer or "")
    return min(int(found[1]), MAX_WAIT_S) if found else 0


async def wait_for_end(
    context: ApiContext,
    job: JobRecord,
    look: Callable[[], JobRecord | None],
    *,
    wait_s: float,
) -> JobRecord:
    """Wait for the end of a job, which ``look`` looks at; returns it in its state by then."""
    deadline = time.monotonic() + wait_s
    while (
        job.state in ACTIVE
        and not context.feed.is_ending
        and (remaining_s := deadline - time.monotonic()) > 0
    ):
        await context.feed.wait_beyond(job.id, job.last_event, timeout_s=remaining_s)
        latest = await run_in_threadpool(look)
        if latest is None:
            raise not_found(what="such fit any more")
        job = latest
    return job
