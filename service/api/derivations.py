"""What is derived from a finished fit, as jobs below it: they are erased and expire with it.

Their paths lie below the fit's, because a derivation does not exist on its own: whoever may see the
fit may see it, and once the fit is gone so is the derivation.
"""

from typing import Any, Final
from uuid import UUID

from fastapi import APIRouter, Request, Response
from fastapi.responses import StreamingResponse
from starlette.concurrency import run_in_threadpool

from api_schemas.derivations import Derivation, DerivationPage, DerivationRequest, DerivationResult
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
)
from service.api.context import ApiContext, Context
from service.api.derivation_inputs import derivation_inputs
from service.api.derivation_kinds import FORM_PARTS
from service.api.derivation_requests import read_derivation
from service.api.events import EVENT_ANSWERS, LastEventId, event_stream
from service.api.fit_inputs import serve_blob
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
from service.api.uploads import MULTIPART
from service.engine.port import JobRecord
from service.representation.jobs import derivations_path, represent_derivation
from service.webhooks.targets import check_webhook

ROUTER: Final = APIRouter(prefix="/v1/fits/{fit_id}/derivations", tags=["derivations"])


_SUBMISSION: Final[dict[str, Any]] = {
    "requestBody": {
        "required": True,
        "content": {
            JSON: json_content(DerivationRequest),
            MULTIPART: {
                "schema": {
                    "type": "object",
                    "additionalProperties": False,
                    "required": ["request"],
                    "properties": {
                        "request": {"$ref": "#/components/schemas/DerivationRequest"},
                    }
                    | {
                        name: {
                            "type": "string",
                            "format": "binary",
                            "description": part.description,
                        }
                        for name, part in FORM_PARTS.items()
                    },
                },
                "encoding": {"request": {"contentType": JSON}}
                | {name: {"contentType": part.media_types} for name, part in FORM_PARTS.items()},
            },
        },
    }
}


@ROUTER.post(
    "",
    status_code=202,
    response_model=Derivation,
    summary="Derive something from a fit",
    openapi_extra=_SUBMISSION,
    responses=accepted(Derivation)
    | documented(
        "malformed-request",
        "not-found",
        "no-result",
        "fit-expired",
        "payload-too-large",
        "unsupported-media-type",
        *ACCEPTANCE_PROBLEMS,
    ),
)
async def derive(
    fit_id: UUID,
    request: Request,
    response: Response,
    context: Context,
    idempotency_key: IdempotencyKey = None,
    prefer: Prefer = None,
) -> Derivation:
    """Accept a job that makes something of a fit that has succeeded; `kind` says what.

    It has copies of its own of what it needs of the fit; erasing the fit erases it too. A file
    comes along as a part of a form, whose part `request` is the JSON: `bvh`, a motion for an
    animation, without which the body walks; `texture`, for a texture with the colours `own`;
    `chart`, a size chart as CSV.

    What follows from the measurements, `size`, `body_composition` and `change`, follows from all of
    them together, with what is known of their errors. A size of a brand's chart, say:
    `curl -F 'request={"kind": "size"}' -F chart=@chart.csv .../derivations`, with a chart such as
    `size,chest_girth,waist_girth_navel`, `M,94-98,80-84`, `L,98-102,84-88`.

    `Idempotency-Key` and `Prefer` are as for fits.
    """
    asked, sent = await read_derivation(request, max_pixels=context.settings.max_pixels)
    check_webhook(asked.webhook, context.settings)
    inputs = await run_in_threadpool(derivation_inputs, context, fit_id, asked, sent.files)
    jobs = context.jobs.derivations(str(fit_id))
    # At most one file comes with a request, and the kind and its options say which.
    brought = b"".join(file.content for file in sent.files.values())
    key = idempotency(idempotency_key, b"derivation", str(fit_id).encode(), sent.text, brought)
    job = await accept(context, jobs, inputs, key=key)
    return represent_derivation(await answer(context, jobs, response, job, prefer=prefer))


@ROUTER.get(
    "",
    response_model=DerivationPage,
    summary="List what was derived from a fit, newest first",
    responses=documented(*JOB_PROBLEMS),
)
def list_derivations(
    fit_id: UUID,
    response: Response,
    context: Context,
    limit: Limit = 50,
    cursor: Cursor = None,
    state: State = None,
) -> DerivationPage:
    """List the jobs; `next` and the Link header lead to the following page."""
    fit = find(context.jobs, fit_id)
    page, following = page_of(
        context.jobs.derivations(fit.id),
        response,
        path=derivations_path(fit.id),
        limit=limit,
        cursor=cursor,
        state=state,
    )
    return DerivationPage(
        derivations=tuple(represent_derivation(record) for record in page), next=following
    )


@ROUTER.get(
    "/{derivation_id}",
    response_model=Derivation,
    summary="Look at a derivation",
    responses=NOT_MODIFIED | documented(*JOB_PROBLEMS),
)
def get_derivation(
    fit_id: UUID,
    derivation_id: UUID,
    response: Response,
    context: Context,
    if_none_match: IfNoneMatch = None,
) -> Any:
    """Return where the job stands."""
    record = _find(context, fit_id, derivation_id)
    return not_modified(record, response, if_none_match) or represent_derivation(record)


@ROUTER.post(
    "/{derivation_id}/cancel",
    status_code=202,
    response_model=Derivation,
    summary="Cancel a derivation",
    responses={
        200: {"model": Derivation, "description": "The job has ended."},
        202: {"description": "The job is being stopped."},
    }
    | documented(*JOB_PROBLEMS),
)
def cancel_derivation(
    fit_id: UUID, derivation_id: UUID, response: Response, context: Context
) -> Derivation:
    """Stop a job; canceling again, or canceling what has ended, changes nothing."""
    jobs = context.jobs.derivations(str(fit_id))
    return represent_derivation(cancel_job(jobs, derivation_id, response))


@ROUTER.delete(
    "/{derivation_id}",
    status_code=204,
    summary="Erase a derivation",
    responses=documented(*JOB_PROBLEMS),
)
def erase_derivation(fit_id: UUID, derivation_id: UUID, context: Context) -> Response:
    """Stop the job if it runs, and erase it with its copies and results; the fit stays."""
    return erase_job(context, context.jobs.derivations(str(fit_id)), derivation_id)


@ROUTER.get(
    "/{derivation_id}/events",
    summary="Follow a derivation",
    response_class=StreamingResponse,
    responses=EVENT_ANSWERS,
)
def follow_derivation(
    fit_id: UUID, derivation_id: UUID, context: Context, last_event_id: LastEventId = None
) -> Response:
    """Stream state changes, stages and progress, as for fits."""
    jobs = context.jobs.derivations(str(fit_id))
    return event_stream(context, jobs, derivation_id, last_event_id)


@ROUTER.get(
    "/{derivation_id}/request",
    summary="The request of a derivation",
    response_class=Response,
    responses={
        200: {
            "description": "As it was understood, defaults included.",
            "content": {JSON: json_content(DerivationRequest)},
        },
    }
    | NOT_MODIFIED
    | documented(*JOB_PROBLEMS),
)
def derivation_request(
    fit_id: UUID, derivation_id: UUID, context: Context, if_none_match: IfNoneMatch = None
) -> Response:
    """Return what was asked for: to be changed and sent again."""
    record = _find(context, fit_id, derivation_id)
    return serve_blob(context, record, record.options, if_none_match)


@ROUTER.get(
    "/{derivation_id}/result",
    summary="The result document of a derivation",
    responses={200: {"model": DerivationResult}}
    | NOT_MODIFIED
    | documented("no-result", *JOB_PROBLEMS),
)
def derivation_result(
    fit_id: UUID, derivation_id: UUID, context: Context, if_none_match: IfNoneMatch = None
) -> Response:
    """Return what there is to say of it, and the files' names."""
    record = _find(context, fit_id, derivation_id)
    return serve_result(context, record, if_none_match=if_none_match)


@ROUTER.get(
    "/{derivation_id}/artifacts/{name}",
    summary="A file of a derivation",
    description="Return a file: `report.pdf`, `body_reposed.glb` and so on, as the job's links "
    f"name them, or `body_reposed.obj` and so on.{NEGOTIATION}",
    response_class=Response,
    responses=file_answers("text/html", "application/pdf", "image/png", "image/webp"),
)
async def derivation_artifact(
    fit_id: UUID,
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
        context.jobs.derivations(str(fit_id)),
        derivation_id,
        name,
        accept=accept,
        range_header=range_header,
        if_range=if_range,
        if_none_match=if_none_match,
    )


def _find(context: ApiContext, fit_id: UUID, derivation_id: UUID) -> JobRecord:
    return find(context.jobs.derivations(str(fit_id)), derivation_id)
