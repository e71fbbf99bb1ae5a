"""The routes that all jobs have: fits, scans, and what is derived from either.

List, show, follow, cancel, retry and erase jobs; read their requests and results.
"""

from typing import Annotated, Any, Final
from uuid import UUID

from fastapi import APIRouter, Depends, Response
from fastapi.responses import StreamingResponse
from starlette.concurrency import run_in_threadpool

from api_schemas.base import WireModel
from api_schemas.jobs import JobStanding
from api_schemas.results import ResultPart
from service.api.acceptance import (
    ACCEPTANCE_PROBLEMS,
    IdempotencyKey,
    Prefer,
    accept,
    accepted,
    answer,
    idempotency,
)
from service.api.artifacts import (
    NEGOTIATION,
    AcceptHeader,
    ArtifactName,
    IfRange,
    RangeHeader,
    answer_artifact,
    file_answers,
    serve_result,
)
from service.api.context import Context
from service.api.events import EVENT_ANSWERS, LastEventId, event_stream
from service.api.job_inputs import inputs_again
from service.api.job_resources import FITS, OF_FITS, OF_SCANS, SCANS, JobResource
from service.api.job_routes import (
    JOB_PROBLEMS,
    NOT_MODIFIED,
    Cursor,
    IfNoneMatch,
    State,
    cancel_job,
    erase_job,
    find,
    jobs_page,
    not_modified,
)
from service.api.json_bodies import JSON, json_content
from service.api.listing import Limit
from service.api.pictures import serve_blob
from service.api.problems import documented
from service.engine.tenant_jobs import TenantJobs
from service.representation.jobs import represent

LIST_PROBLEMS: Final = ("invalid-request", "not-ready", "internal-error")


def job_router(of: JobResource) -> APIRouter:
    """Make the routes of one resource."""
    router = APIRouter(prefix=of.path)
    _add_standing(router, of)
    _add_changes(router, of)
    _add_files(router, of)
    return router


def _add_standing(router: APIRouter, of: JobResource) -> None:
    """Add the routes by which jobs are listed, looked at and followed."""

    @router.get(
        "",
        name=of.operations["list"],
        tags=[of.tag],
        response_model=of.page,
        summary=f"List {of.noun}s, newest first",
        responses=documented(*(LIST_PROBLEMS if of.parent is None else JOB_PROBLEMS)),
    )
    def list_all(
        jobs: Annotated[TenantJobs, Depends(of.jobs)],
        label: Annotated[str | None, Depends(of.label)],
        response: Response,
        limit: Limit = 50,
        cursor: Cursor = None,
        state: State = None,
    ) -> WireModel:
        """List jobs; `next` and the Link header lead to the following page."""
        page, following = jobs_page(
            jobs, response, limit=limit, cursor=cursor, state=state, label=label
        )
        return of.page(**{of.listed: tuple(map(represent, page)), "next": following})

    @router.get(
        of.id_below,
        name=of.operations["get"],
        tags=[of.tag],
        response_model=of.model,
        summary=f"Look at a {of.noun}",
        responses=NOT_MODIFIED | documented(*JOB_PROBLEMS),
    )
    def get(
        jobs: Annotated[TenantJobs, Depends(of.jobs)],
        job_id: Annotated[UUID, of.id],
        response: Response,
        if_none_match: IfNoneMatch = None,
    ) -> Any:
        """Return where the job stands."""
        record = find(jobs, job_id)
        return not_modified(record, response, if_none_match) or represent(record)

    @router.get(
        f"{of.id_below}/events",
        name=of.operations["follow"],
        tags=[of.tag],
        summary=f"Follow a {of.noun}",
        response_class=StreamingResponse,
        responses=EVENT_ANSWERS,
    )
    def follow(
        jobs: Annotated[TenantJobs, Depends(of.jobs)],
        job_id: Annotated[UUID, of.id],
        context: Context,
        last_event_id: LastEventId = None,
    ) -> Response:
        """Stream state changes, stages, progress and energies; `view` says of which picture.

        All events since the job was accepted are kept: a client that comes late or reconnects
        misses none.
        """
        return event_stream(context, jobs, job_id, last_event_id)


def _add_changes(router: APIRouter, of: JobResource) -> None:
    """Add the routes by which jobs are stopped, made again and erased."""

    @router.post(
        f"{of.id_below}/cancel",
        name=of.operations["cancel"],
        tags=[of.tag],
        status_code=202,
        response_model=of.model,
        summary=f"Cancel a {of.noun}",
        responses={
            200: {"model": of.model, "description": "The job has ended."},
            202: {"description": "The job is being stopped."},
        }
        | documented(*JOB_PROBLEMS),
    )
    def cancel(
        jobs: Annotated[TenantJobs, Depends(of.jobs)],
        job_id: Annotated[UUID, of.id],
        response: Response,
    ) -> JobStanding:
        """Stop a job; canceling again, or canceling what has ended, changes nothing."""
        return represent(cancel_job(jobs, job_id, response))

    @router.post(
        f"{of.id_below}/retry",
        name=of.operations["retry"],
        tags=[of.tag],
        status_code=202,
        response_model=of.model,
        summary=f"Make a {of.noun} again",
        responses=accepted(of.model)
        | documented("not-found", "fit-expired", "not-ended", *ACCEPTANCE_PROBLEMS),
    )
    async def retry(
        jobs: Annotated[TenantJobs, Depends(of.jobs)],
        job_id: Annotated[UUID, of.id],
        response: Response,
        context: Context,
        idempotency_key: IdempotencyKey = None,
        prefer: Prefer = None,
    ) -> JobStanding:
        """Accept a new job on all that one that has ended was made of, its request included.

        It has copies of its own of that, and its notice goes where the first one's went.
        """
        inputs = await run_in_threadpool(inputs_again, context, jobs, job_id)
        key = idempotency(idempotency_key, b"retry", str(job_id).encode())
        job = await accept(context, jobs, inputs, key=key)
        return represent(await answer(context, jobs, response, job, prefer=prefer))

    @router.delete(
        of.id_below,
        name=of.operations["erase"],
        tags=[of.tag],
        status_code=204,
        summary=f"Erase a {of.noun}",
        description=f"Stop the job if it runs, and erase it with {of.erased}.",
        responses=documented(*JOB_PROBLEMS),
    )
    def erase(
        jobs: Annotated[TenantJobs, Depends(of.jobs)],
        job_id: Annotated[UUID, of.id],
        context: Context,
    ) -> Response:
        return erase_job(context, jobs, job_id)


def _add_files(router: APIRouter, of: JobResource) -> None:
    """Add the routes of what was asked for and what came of it."""

    @router.get(
        f"{of.id_below}/request",
        name=of.operations["request"],
        tags=[of.tag],
        summary=f"The request of a {of.noun}",
        response_class=Response,
        responses={
            200: {
                "description": "As it was understood, defaults included.",
                "content": {JSON: json_content(of.options)},
            },
        }
        | NOT_MODIFIED
        | documented(*JOB_PROBLEMS),
    )
    def request_of(
        jobs: Annotated[TenantJobs, Depends(of.jobs)],
        job_id: Annotated[UUID, of.id],
        context: Context,
        if_none_match: IfNoneMatch = None,
    ) -> Response:
        """Return what was asked for, with names for all points: to be changed and sent again."""
        record = find(jobs, job_id)
        return serve_blob(context, record, record.options, if_none_match)

    @router.get(
        f"{of.id_below}/result",
        name=of.operations["result"],
        tags=[of.results_tag],
        summary=f"The result document of a {of.noun}",
        description=f"Return {of.holds}, and the files' names.",
        responses={200: {"model": of.result}}
        | NOT_MODIFIED
        | documented("no-result", *JOB_PROBLEMS),
    )
    def result(
        jobs: Annotated[TenantJobs, Depends(of.jobs)],
        job_id: Annotated[UUID, of.id],
        included: Annotated[frozenset[ResultPart], Depends(of.included)],
        context: Context,
        if_none_match: IfNoneMatch = None,
    ) -> Response:
        return serve_result(
            context,
            find(jobs, job_id),
            kind=of.result,
            included=included,
            if_none_match=if_none_match,
        )

    @router.get(
        f"{of.id_below}/artifacts/{{name}}",
        name=of.operations["artifact"],
        tags=[of.results_tag],
        summary=f"A file of a {of.noun}",
        description=f"Return a file: {of.files} and so on.{NEGOTIATION}",
        response_class=Response,
        responses=file_answers(*of.media_types),
    )
    async def artifact(
        jobs: Annotated[TenantJobs, Depends(of.jobs)],
        job_id: Annotated[UUID, of.id],
        name: ArtifactName,
        context: Context,
        if_none_match: IfNoneMatch = None,
        range_header: RangeHeader = None,
        if_range: IfRange = None,
        accept: AcceptHeader = None,
    ) -> Response:
        return await answer_artifact(
            context,
            jobs,
            job_id,
            name,
            accept=accept,
            range_header=range_header,
            if_range=if_range,
            if_none_match=if_none_match,
        )


ROUTER: Final = APIRouter()
for _each in (FITS, SCANS, OF_FITS, OF_SCANS):
    ROUTER.include_router(job_router(_each))
