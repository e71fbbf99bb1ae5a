"""Ask for something to be derived from a finished fit or scan: a job below it.

Its path lies below what it is made of, because a derivation does not exist on its own: whoever may
see that may see it, and once that is gone so is the derivation.
"""

from collections.abc import Collection, Mapping
from dataclasses import dataclass
from typing import Annotated, Any, Final

from fastapi import APIRouter, Depends, Request, Response
from starlette.concurrency import run_in_threadpool

from api_schemas.derivation_kinds import AnyDerivationOptions
from api_schemas.derivations import DerivationRequest
from api_schemas.jobs import JobStanding, JobState
from api_schemas.problems import FieldProblem
from service.api.acceptance import (
    ACCEPTANCE_PROBLEMS,
    IdempotencyKey,
    Prefer,
    accept,
    accepted,
    answer,
    idempotency,
)
from service.api.artifacts import no_result
from service.api.context import Context
from service.api.derivation_kinds import FORM_PARTS, needs_of
from service.api.job_inputs import Copy, File, Inputs
from service.api.job_resources import OF_FITS, OF_SCANS, JobResource
from service.api.json_bodies import JSON, json_content, media_type, read_json_text, unsupported
from service.api.problems import ProblemError, documented
from service.api.uploads import MULTIPART, read_request_and_files
from service.engine.port import SCAN, JobRecord, StoredBlob
from service.engine.tenant_jobs import TenantJobs
from service.jobs.inputs import OF_FIRST_VIEW, REQUEST
from service.representation.jobs import represent
from service.submissions.refusal import refused
from service.submissions.validation import parsed
from service.webhooks.targets import check_webhook

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


_DESCRIPTION: Final = """Accept a job that makes something of a {root} that has succeeded; `kind` \
says what.

It has copies of its own of what it needs of the {root}; erasing the {root} erases it too. A file
comes along as a part of a form, whose part `request` is the JSON: `bvh`, a motion for an
animation, without which the body walks; `texture`, for a texture with the colours `own`; `chart`,
a size chart as CSV.

What follows from the measurements, `size` and `body_composition`, follows from all of them
together, with what is known of their errors. A size of a brand's chart, say:
`curl -F 'request={{"kind": "size"}}' -F chart=@chart.csv .../derivations`, with a chart such as
`size,chest_girth,waist_girth_navel`, `M,94-98,80-84`, `L,98-102,84-88`.

`Idempotency-Key` and `Prefer` are as for fits."""


def _router(of: JobResource) -> APIRouter:
    """Make the route by which derivations of fits, or of scans, are accepted."""
    router = APIRouter(prefix=of.path, tags=[of.tag])
    assert of.parent is not None

    @router.post(
        "",
        name=of.operations["submit"],
        status_code=202,
        response_model=of.model,
        summary=f"Derive something from a {of.root}",
        description=_DESCRIPTION.format(root=of.root),
        openapi_extra=_SUBMISSION,
        responses=accepted(of.model)
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
        jobs: Annotated[TenantJobs, Depends(of.jobs)],
        made_of: Annotated[JobRecord, Depends(of.parent)],
        request: Request,
        response: Response,
        context: Context,
        idempotency_key: IdempotencyKey = None,
        prefer: Prefer = None,
    ) -> JobStanding:
        asked, sent = await read_derivation(request, max_pixels=context.settings.max_pixels)
        check_webhook(asked.webhook, context.settings)
        inputs = derivation_inputs(made_of, asked, sent.files)
        # At most one file comes with a request, and the kind and its options say which.
        brought = b"".join(file.content for file in sent.files.values())
        key = idempotency(idempotency_key, b"derivation", made_of.id.encode(), sent.text, brought)
        job = await accept(context, jobs, inputs, key=key)
        return represent(await answer(context, jobs, response, job, prefer=prefer))

    return router


@dataclass(frozen=True, slots=True, kw_only=True)
class Sent:
    """The request as JSON text, and the files sent with it, by the names of their parts."""

    text: bytes
    files: Mapping[str, File]


async def read_derivation(
    request: Request, *, max_pixels: int
) -> tuple[AnyDerivationOptions, Sent]:
    """Read the request: JSON, or a form with it and a file.

    Raises
    ------
    RefusedError, ProblemError
        If it is neither, or its content is invalid.
    """
    if media_type(request) == JSON:
        text, parts = await read_json_text(request), {}
        asked = parsed(DerivationRequest, text, whole="body", called="the body").root
    elif media_type(request) == MULTIPART:
        text, parts = await read_request_and_files(request, tuple(FORM_PARTS))
        asked = parsed(DerivationRequest, text, whole="request", called="the part 'request'").root
    else:
        raise unsupported(
            request,
            remedy=f"Send {JSON}, or {MULTIPART} with the parts 'request' and "
            f"{' or '.join(map(repr, FORM_PARTS))}.",
            accepted=f"{JSON}, {MULTIPART}",
        )
    _refuse_wrong_parts(asked, parts)
    files = await run_in_threadpool(_checked, asked, parts, max_pixels)
    return asked, Sent(text=text, files=files)


def _checked(
    asked: AnyDerivationOptions, parts: Mapping[str, bytes], max_pixels: int
) -> dict[str, File]:
    return {
        name: File(content=content, media_type=FORM_PARTS[name].check(content, asked, max_pixels))
        for name, content in parts.items()
    }


def _refuse_wrong_parts(asked: AnyDerivationOptions, parts: Mapping[str, bytes]) -> None:
    needs = needs_of(asked)
    taken = None if needs.part is None else needs.part.name
    if taken is not None and needs.part_is_for is not None and taken not in parts:
        raise refused(
            FieldProblem(
                field=taken,
                code="missing",
                reason=f"The part '{taken}' is missing, which {needs.part_is_for}.",
                remedy=f"Send {MULTIPART} with the parts 'request' and '{taken}'.",
            )
        )
    for name in parts:
        if name != taken:
            raise refused(
                FieldProblem(
                    field=name,
                    code="unknown-field",
                    reason=f"This request for a derivation of kind {asked.kind} takes no part "
                    f"'{name}'.",
                    remedy="Send the request alone, as JSON, or ask for "
                    f"{FORM_PARTS[name].sent_for}.",
                )
            )


def derivation_inputs(
    parent: JobRecord, options: AnyDerivationOptions, sent: Mapping[str, File]
) -> Inputs:
    """What a derivation needs from its fit or scan, besides what was sent.

    Raises
    ------
    ProblemError
        If that has no result.
    """
    if parent.state is not JobState.SUCCEEDED:
        raise ProblemError(no_result(parent))
    return Inputs(
        kind=options.kind,
        options=options.model_dump_json(exclude={"webhook"}).encode(),
        files={**_copies_of(parent, needs_of(options).of_fit), **sent},
        webhook=options.webhook,
    )


def _copies_of(parent: JobRecord, needed: Collection[str]) -> dict[str, Copy]:
    """Copies of those inputs and files that a fit has; of a scan its first picture's."""
    kept = dict(parent.inputs) | {REQUEST: parent.options}
    kept |= {
        artifact.name: StoredBlob(digest=artifact.sha256, media_type=artifact.media_type)
        for artifact in parent.artifacts
    }
    if parent.root == SCAN:
        kept |= {name: kept[first] for name, first in OF_FIRST_VIEW.items() if first in kept}
    return {name: Copy(scope=parent.id, blob=kept[name]) for name in needed if name in kept}


ROUTER: Final = APIRouter()
for _each in (OF_FITS, OF_SCANS):
    ROUTER.include_router(_router(_each))
