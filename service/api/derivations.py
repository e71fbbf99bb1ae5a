"""What is derived from a finished fit or scan, as jobs below it: they go and expire with it.

Their paths lie below what they are made of, because a derivation does not exist on its own: whoever
may see that may see it, and once that is gone so is the derivation. The routes are the same below
both; they differ in names and in the types of their answers.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Final
from uuid import UUID

from fastapi import APIRouter, Path, Request, Response
from fastapi.responses import StreamingResponse
from starlette.concurrency import run_in_threadpool

from api_schemas.base import WireModel
from api_schemas.derivations import Derivation, DerivationPage, DerivationRequest, DerivationResult
from api_schemas.jobs import JobStanding
from api_schemas.scans import ScanDerivation, ScanDerivationPage
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
from service.api.retries import RETRY_PROBLEMS, accept_again
from service.api.uploads import MULTIPART
from service.engine.port import FIT, SCAN, JobRecord, TenantJobs
from service.representation.jobs import (
    collection_path,
    derivations_path,
    represent_derivation,
    represent_scan_derivation,
)
from service.webhooks.targets import check_webhook


@dataclass(frozen=True, slots=True, kw_only=True)
class Parents:
    """What derivations are made of: fits, or scans.

    ``jobs`` are those of the caller. Names of operations end in ``suffix``. ``represent`` makes an
    answer of the type ``model`` of a record.
    """

    root: str
    suffix: str
    jobs: Callable[[ApiContext], TenantJobs]
    model: type[JobStanding]
    page: Callable[..., WireModel]
    represent: Callable[[JobRecord], JobStanding]

    @property
    def path(self) -> str:
        """Below the service's root, with its parameter."""
        return f"{collection_path(self.root)}/{{{self.root}_id}}/derivations"

    @property
    def parameter(self) -> Any:
        """Its id in the path."""
        return Path(alias=f"{self.root}_id", title=f"{self.root.capitalize()} Id")

    def below(self, context: ApiContext, parent_id: UUID) -> TenantJobs:
        """What is derived from one of them."""
        return self.jobs(context).derivations(str(parent_id))


FITS: Final = Parents(
    root=FIT,
    suffix="",
    jobs=lambda context: context.jobs,
    model=Derivation,
    page=DerivationPage,
    represent=represent_derivation,
)
SCANS: Final = Parents(
    root=SCAN,
    suffix="_of_scan",
    jobs=lambda context: context.scans,
    model=ScanDerivation,
    page=ScanDerivationPage,
    represent=represent_scan_derivation,
)

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


def _router(parents: Parents) -> APIRouter:
    router = APIRouter(prefix=parents.path, tags=["derivations"])
    _add_acceptance(router, parents)
    _add_standing(router, parents)
    _add_files(router, parents)
    return router


def _add_acceptance(router: APIRouter, parents: Parents) -> None:
    """Add the routes by which jobs are accepted."""
    root, parent = parents.root, parents.parameter

    @router.post(
        "",
        name=f"derive{parents.suffix}",
        status_code=202,
        response_model=parents.model,
        summary=f"Derive something from a {root}",
        description=f"""Accept a job that makes something of a {root} that has succeeded; `kind` \
says what.

It has copies of its own of what it needs of the {root}; erasing the {root} erases it too. A file
comes along as a part of a form, whose part `request` is the JSON: `bvh`, a motion for an
animation, without which the body walks; `texture`, for a texture with the colours `own`; `chart`,
a size chart as CSV.

What follows from the measurements, `size`, `body_composition` and `change`, follows from all of
them together, with what is known of their errors. A size of a brand's chart, say:
`curl -F 'request={{"kind": "size"}}' -F chart=@chart.csv .../derivations`, with a chart such as
`size,chest_girth,waist_girth_navel`, `M,94-98,80-84`, `L,98-102,84-88`.

`Idempotency-Key` and `Prefer` are as for fits.""",
        openapi_extra=_SUBMISSION,
        responses=accepted(parents.model)
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
        *,
        parent_id: UUID = parent,
        request: Request,
        response: Response,
        context: Context,
        idempotency_key: IdempotencyKey = None,
        prefer: Prefer = None,
    ) -> JobStanding:
        asked, sent = await read_derivation(request, max_pixels=context.settings.max_pixels)
        check_webhook(asked.webhook, context.settings)
        roots = parents.jobs(context)
        made_of = await run_in_threadpool(find, roots, parent_id)
        inputs = await run_in_threadpool(derivation_inputs, roots, made_of, asked, sent.files)
        jobs = parents.below(context, parent_id)
        # At most one file comes with a request, and the kind and its options say which.
        brought = b"".join(file.content for file in sent.files.values())
        key = idempotency(
            idempotency_key, b"derivation", str(parent_id).encode(), sent.text, brought
        )
        job = await accept(context, jobs, inputs, key=key)
        return parents.represent(await answer(context, jobs, response, job, prefer=prefer))

    @router.post(
        "/{derivation_id}/retry",
        name=f"retry_derivation{parents.suffix}",
        status_code=202,
        response_model=parents.model,
        summary="Derive the same again",
        responses=accepted(parents.model) | documented(*RETRY_PROBLEMS),
    )
    async def retry(
        *,
        parent_id: UUID = parent,
        derivation_id: UUID,
        response: Response,
        context: Context,
        idempotency_key: IdempotencyKey = None,
        prefer: Prefer = None,
    ) -> JobStanding:
        """Accept a new job on all that one that has ended was made of.

        It has a copy of its own of that, and its notice goes where the first one's went.
        """
        jobs = parents.below(context, parent_id)
        return parents.represent(
            await accept_again(
                context, jobs, derivation_id, response, key=idempotency_key, prefer=prefer
            )
        )

    _ = (derive, retry)


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
