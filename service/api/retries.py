"""A new job with the inputs of one that has ended."""

from typing import Final
from uuid import UUID

from fastapi import APIRouter, Response
from starlette.concurrency import run_in_threadpool

from api_schemas.derivations import DerivationRequest
from api_schemas.jobs import Job
from api_schemas.problems import problem
from service.api.acceptance import (
    ACCEPTANCE_PROBLEMS,
    IdempotencyKey,
    Prefer,
    accept,
    accepted,
    answer,
    idempotency,
)
from service.api.context import ApiContext, Context
from service.api.derivation_kinds import needs_of
from service.api.job_inputs import Copy, Inputs
from service.api.job_routes import find
from service.api.problems import ProblemError, documented, not_found
from service.blobs import BlobMissingError
from service.engine.port import JobRecord, TenantJobs
from service.jobs.inputs import SANDBOX
from service.jobs.states import ACTIVE
from service.representation.jobs import represent
from service.webhooks.targets import read_target

ROUTER: Final = APIRouter(prefix="/v1/fits", tags=["fits"])

RETRY_PROBLEMS: Final = ("not-found", "fit-expired", "not-ended", *ACCEPTANCE_PROBLEMS)


@ROUTER.post(
    "/{fit_id}/retry",
    status_code=202,
    response_model=Job,
    summary="Fit the same picture again",
    responses=accepted(Job) | documented(*RETRY_PROBLEMS),
)
async def retry(
    fit_id: UUID,
    response: Response,
    context: Context,
    idempotency_key: IdempotencyKey = None,
    prefer: Prefer = None,
) -> Job:
    """Accept a new job on the picture and the request of one that has ended.

    It has a copy of its own of both, and its notice goes where the first one's went.
    """
    return represent(
        await accept_again(
            context, context.jobs, fit_id, response, key=idempotency_key, prefer=prefer
        )
    )


async def accept_again(
    context: ApiContext,
    jobs: TenantJobs,
    job_id: UUID,
    response: Response,
    *,
    key: str | None,
    prefer: str | None,
) -> JobRecord:
    """Accept a new job with copies of all that one that has ended was made of.

    Raises
    ------
    ProblemError
        If it has not ended, or is gone.
    """
    inputs = await run_in_threadpool(_inputs, context, jobs, job_id)
    hashed = idempotency(key, b"retry", str(job_id).encode())
    job = await accept(context, jobs, inputs, key=hashed)
    return await answer(context, jobs, response, job, prefer=prefer)


def _inputs(context: ApiContext, jobs: TenantJobs, job_id: UUID) -> Inputs:
    record = find(jobs, job_id)
    if record.state in ACTIVE:
        raise ProblemError(
            problem(
                "not-ended",
                detail=f"The job is {record.state}.",
                remedy="Wait for its end, or cancel it first.",
            )
        )

    try:
        options = context.blobs.get(record.id, record.options.digest)
        webhook = read_target(context.blobs, record)
    except BlobMissingError as error:
        raise not_found(what="such job any more") from error
    return Inputs(
        kind=record.kind,
        options=options,
        files={
            name: Copy(scope=record.id, blob=blob)
            for name, blob in record.inputs.items()
            # What a sandbox was asked for was done: the retry ends as usual.
            if name != SANDBOX
        },
        pictures=record.pictures,
        label=record.label,
        sources=() if record.parent is None else _sources(options),
        webhook=webhook,
    )


def _sources(options: bytes) -> tuple[str, ...]:
    asked = DerivationRequest.model_validate_json(options).root
    return tuple(map(str, needs_of(asked).other_fits.values()))
