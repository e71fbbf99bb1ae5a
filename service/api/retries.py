"""A new job on the input of one that has ended."""

from typing import Final
from uuid import UUID

from fastapi import APIRouter, Response
from starlette.concurrency import run_in_threadpool

from api_schemas.jobs import Job
from api_schemas.problems import problem
from service.api.acceptance import (
    ACCEPTANCE_PROBLEMS,
    File,
    IdempotencyKey,
    Inputs,
    Prefer,
    accept,
    accepted,
    answer,
    idempotency,
)
from service.api.context import ApiContext, Context
from service.api.job_routes import find
from service.api.problems import ProblemError, documented, not_found
from service.api.representation import represent
from service.blobs import BlobMissingError
from service.engine.port import StoredBlob
from service.jobs import ACTIVE

ROUTER: Final = APIRouter(prefix="/v1/fits", tags=["fits"])


@ROUTER.post(
    "/{fit_id}/retry",
    status_code=202,
    response_model=Job,
    summary="Fit the same picture again",
    responses=accepted(Job)
    | documented("not-found", "fit-expired", "not-ended", *ACCEPTANCE_PROBLEMS),
)
async def retry(
    fit_id: UUID,
    response: Response,
    context: Context,
    idempotency_key: IdempotencyKey = None,
    prefer: Prefer = None,
) -> Job:
    """Accept a new job on the picture and the request of one that has ended.

    It has a copy of its own of both, and its end is told to whom the first one's was.
    """
    inputs = await run_in_threadpool(_inputs, context, fit_id)
    key = idempotency(idempotency_key, b"retry", str(fit_id).encode())
    job = await accept(context, context.jobs, inputs, key=key)
    return represent(await answer(context, context.jobs, response, job, prefer=prefer))


def _inputs(context: ApiContext, fit_id: UUID) -> Inputs:
    record = find(context.jobs, fit_id)
    if record.state in ACTIVE:
        raise ProblemError(
            problem(
                "not-ended",
                detail=f"The job is {record.state}.",
                remedy="Wait for its end, or cancel it first.",
            )
        )

    def file(blob: StoredBlob) -> File:
        return File(content=context.blobs.get(record.id, blob.digest), media_type=blob.media_type)

    try:
        return Inputs(
            options=file(record.options).content,
            files={name: file(blob) for name, blob in record.inputs.items()},
            webhook=context.jobs.webhook_target(record.id),
        )
    except BlobMissingError as error:
        raise not_found(what="such job any more") from error
