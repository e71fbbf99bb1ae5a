"""What is derived from a finished fit or scan, as jobs below it: they go and expire with it.

Their paths lie below what they are made of, because a derivation does not exist on its own: whoever
may see that may see it, and once that is gone so is the derivation. The routes are the same below
both; they differ in names and in the types of their answers.
"""

from typing import Any, Final
from uuid import UUID

from fastapi import APIRouter, Response
from fastapi.responses import StreamingResponse

from api_schemas.base import WireModel
from api_schemas.derivations import DerivationRequest, DerivationResult
from api_schemas.jobs import JobStanding
from service.api.artifacts import (
    NEGOTIATION,
    AcceptHeader,
    ArtifactName,
    IfRange,
    RangeHeader,
    answer_artifact,
    file_answers,
)
from service.api.context import Context
from service.api.derivation_acceptance import add_acceptance
from service.api.derivation_parents import FITS, SCANS, Parents
from service.api.events import EVENT_ANSWERS, LastEventId, event_stream
from service.api.fit_inputs import UNDERSTOOD, serve_blob
from service.api.job_routes import (
    JOB_PROBLEMS,
    NOT_MODIFIED,
    Cursor,
    IfNoneMatch,
    Limit,
    State,
    cancel_job,
    erase_job,
    find,
    not_modified,
    page_of,
)
from service.api.json_bodies import (
    JSON,
    json_content,
)
from service.api.problems import documented
from service.api.results import serve_result
from service.representation.jobs import (
    derivations_path,
)


def _router(parents: Parents) -> APIRouter:
    router = APIRouter(prefix=parents.path, tags=["derivations"])
    add_acceptance(router, parents)
    _add_standing(router, parents)
    _add_files(router, parents)
    return router


def _add_standing(router: APIRouter, parents: Parents) -> None:
    """Add the routes by which jobs are listed, looked at, followed and stopped."""
    root, parent = parents.root, parents.parameter

    @router.get(
        "",
        name=f"list_derivations{parents.suffix}",
        response_model=parents.page,
        summary=f"List what was derived from a {root}, newest first",
        responses=documented(*JOB_PROBLEMS),
    )
    def list_all(
        *,
        parent_id: UUID = parent,
        response: Response,
        context: Context,
        limit: Limit = 50,
        cursor: Cursor = None,
        state: State = None,
    ) -> WireModel:
        """List the jobs; `next` and the Link header lead to the following page."""
        made_of = find(parents.jobs(context), parent_id)
        page, following = page_of(
            parents.below(context, parent_id),
            response,
            path=derivations_path(root, made_of.id),
            limit=limit,
            cursor=cursor,
            state=state,
        )
        return parents.page(
            derivations=tuple(parents.represent(record) for record in page), next=following
        )

    @router.get(
        "/{derivation_id}",
        name=f"get_derivation{parents.suffix}",
        response_model=parents.model,
        summary="Look at a derivation",
        responses=NOT_MODIFIED | documented(*JOB_PROBLEMS),
    )
    def get(
        *,
        parent_id: UUID = parent,
        derivation_id: UUID,
        response: Response,
        context: Context,
        if_none_match: IfNoneMatch = None,
    ) -> Any:
        """Return where the job stands."""
        record = find(parents.below(context, parent_id), derivation_id)
        return not_modified(record, response, if_none_match) or parents.represent(record)

    @router.post(
        "/{derivation_id}/cancel",
        name=f"cancel_derivation{parents.suffix}",
        status_code=202,
        response_model=parents.model,
        summary="Cancel a derivation",
        responses={
            200: {"model": parents.model, "description": "The job has ended."},
            202: {"description": "The job is being stopped."},
        }
        | documented(*JOB_PROBLEMS),
    )
    def cancel(
        *, parent_id: UUID = parent, derivation_id: UUID, response: Response, context: Context
    ) -> JobStanding:
        """Stop a job; canceling again, or canceling what has ended, changes nothing."""
        jobs = parents.below(context, parent_id)
        return parents.represent(cancel_job(jobs, derivation_id, response))

    @router.delete(
        "/{derivation_id}",
        name=f"erase_derivation{parents.suffix}",
        status_code=204,
        summary="Erase a derivation",
        description="Stop the job if it runs, and erase it with its copies and results; the "
        f"{root} stays.",
        responses=documented(*JOB_PROBLEMS),
    )
    def erase(*, parent_id: UUID = parent, derivation_id: UUID, context: Context) -> Response:
        return erase_job(context, parents.below(context, parent_id), derivation_id)

    @router.get(
        "/{derivation_id}/events",
        name=f"follow_derivation{parents.suffix}",
        summary="Follow a derivation",
        response_class=StreamingResponse,
        responses=EVENT_ANSWERS,
    )
    def follow(
        *,
        parent_id: UUID = parent,
        derivation_id: UUID,
        context: Context,
        last_event_id: LastEventId = None,
    ) -> Response:
        """Stream state changes, stages and progress, as for fits."""
        jobs = parents.below(context, parent_id)
        return event_stream(context, jobs, derivation_id, last_event_id)

    _ = (list_all, get, cancel, erase, follow)


def _add_files(router: APIRouter, parents: Parents) -> None:
    """Add the routes of what was asked for and what came of it."""
    parent = parents.parameter

    @router.get(
        "/{derivation_id}/request",
        name=f"derivation_request{parents.suffix}",
        summary="The request of a derivation",
        response_class=Response,
        responses={
            200: {
                "description": UNDERSTOOD,
                "content": {JSON: json_content(DerivationRequest)},
            },
        }
        | NOT_MODIFIED
        | documented(*JOB_PROBLEMS),
    )
    def request_of(
        *,
        parent_id: UUID = parent,
        derivation_id: UUID,
        context: Context,
        if_none_match: IfNoneMatch = None,
    ) -> Response:
        """Return what was asked for: to be changed and sent again."""
        record = find(parents.below(context, parent_id), derivation_id)
        return serve_blob(context, record, record.options, if_none_match)

    @router.get(
        "/{derivation_id}/result",
        name=f"derivation_result{parents.suffix}",
        summary="The result document of a derivation",
        responses={200: {"model": DerivationResult}}
        | NOT_MODIFIED
        | documented("no-result", *JOB_PROBLEMS),
    )
    def result(
        *,
        parent_id: UUID = parent,
        derivation_id: UUID,
        context: Context,
        if_none_match: IfNoneMatch = None,
    ) -> Response:
        """Return what there is to say of it, and the files' names."""
        record = find(parents.below(context, parent_id), derivation_id)
        return serve_result(context, record, if_none_match=if_none_match)

    @router.get(
        "/{derivation_id}/artifacts/{name}",
        name=f"derivation_artifact{parents.suffix}",
        summary="A file of a derivation",
        description="Return a file: `report.pdf`, `body_reposed.glb` and so on, as the job's links "
        f"name them, or `body_reposed.obj` and so on.{NEGOTIATION}",
        response_class=Response,
        responses=file_answers("text/html", "application/pdf", "image/png", "image/webp"),
    )
    async def artifact(
        *,
        parent_id: UUID = parent,
        derivation_id: UUID,
        name: ArtifactName,
        context: Context,
        if_none_match: IfNoneMatch = None,
        range_header: RangeHeader = None,
        if_range: IfRange = None,
        accept: AcceptHeader = None,
    ) -> Response:
        """Return a file, a part of it, or the same mesh in another format."""
        return await answer_artifact(
            context,
            parents.below(context, parent_id),
            derivation_id,
            name,
            accept=accept,
            range_header=range_header,
            if_range=if_range,
            if_none_match=if_none_match,
        )

    _ = (request_of, result, artifact)


ROUTER: Final = APIRouter()
for _each in (FITS, SCANS):
    ROUTER.include_router(_router(_each))
