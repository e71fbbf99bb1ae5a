"""The routes by which derivations are accepted: asked for, and asked for once more."""

from typing import Any, Final
from uuid import UUID

from fastapi import APIRouter, Request, Response
from starlette.concurrency import run_in_threadpool

from api_schemas.derivations import DerivationRequest
from api_schemas.jobs import JobStanding
from service.api.acceptance import (
    ACCEPTANCE_PROBLEMS,
    IdempotencyKey,
    Prefer,
    accept,
    accepted,
    answer,
    idempotency,
)
from service.api.context import Context
from service.api.derivation_inputs import derivation_inputs
from service.api.derivation_kinds import FORM_PARTS
from service.api.derivation_parents import Parents
from service.api.derivation_requests import read_derivation
from service.api.job_routes import (
    find,
)
from service.api.json_bodies import (
    JSON,
    json_content,
)
from service.api.problems import documented
from service.api.retries import RETRY_PROBLEMS, accept_again
from service.api.sandbox import asked_of_derivation
from service.api.uploads import MULTIPART
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


def add_acceptance(router: APIRouter, parents: Parents) -> None:
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
        sent_along = {**sent.files, **asked_of_derivation(context, made_of)}
        inputs = await run_in_threadpool(derivation_inputs, roots, made_of, asked, sent_along)
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
