"""Products of a fit: ask for one, look at it, read its files.

They lie below their fit and in its storage: whoever may see the fit may see them, and once it is
gone so are they.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import partial
from typing import Annotated, Any, Final
from uuid import uuid4

from fastapi import APIRouter, Path, Request, Response
from starlette.concurrency import run_in_threadpool

from api_schemas.jobs import JobState
from api_schemas.problems import FieldProblem
from api_schemas.products import AnyProductOptions, Product, ProductRequest, product_id
from service.api.acceptance import Prefer, accepted_job, preferred_wait_s, wait_for_end
from service.api.context import ApiContext, Context
from service.api.files import (
    NEGOTIATION,
    FileName,
    Wanted,
    answer_file,
    file_answers,
    stored_content,
)
from service.api.fits import FIT_PROBLEMS, Found, no_result
from service.api.json_bodies import JSON, json_content, media_type, read_json_text, unsupported
from service.api.problems import ProblemError, documented, not_found
from service.api.product_parts import FORM_PARTS
from service.api.renditions import chosen_rendition
from service.api.storage import disk_full, erase_at_once, storing
from service.api.uploads import MULTIPART, file_part, read_request_and_files
from service.jobs.inputs import RESULT, product_inputs
from service.jobs.records import ACTIVE, JobRecord, NewJob, StoredBlob, Submission, SubmitOutcome
from service.representation.jobs import FITS, POLL_AFTER_S
from service.representation.products import (
    PRODUCTS,
    product_files,
    product_path,
    represent_product,
)
from service.submissions.refusal import parsed, refused

ROUTER: Final = APIRouter(prefix=f"{FITS}/{{fit_id}}/{PRODUCTS}", tags=["products"])

_BODY: Final[dict[str, Any]] = {
    "required": True,
    "content": {
        JSON: json_content(ProductRequest),
        MULTIPART: {
            "schema": {
                "type": "object",
                "additionalProperties": False,
                "required": ["request"],
                "properties": {"request": json_content(ProductRequest)["schema"]}
                | {name: file_part(part.description) for name, part in FORM_PARTS.items()},
            },
            "encoding": {"request": {"contentType": JSON}}
            | {name: {"contentType": part.media_types} for name, part in FORM_PARTS.items()},
        },
    },
}

_FILE_TYPES: Final = ("image/jpeg", "image/png", "image/webp", "text/html")
"""The kinds of files that are neither meshes nor JSON."""

ProductId = Annotated[str, Path(pattern="^[0-9a-f]{32}$")]


@ROUTER.post(
    "",
    status_code=202,
    response_model=Product,
    summary="Ask for a product",
    openapi_extra={"requestBody": _BODY},
    responses={
        200: {"model": Product, "description": "It is there, or making it has failed."},
        202: {
            "description": "It is being made.",
            "headers": {
                "Location": {"description": "Path of the product.", "schema": {"type": "string"}},
                "Retry-After": {"description": "Seconds to wait.", "schema": {"type": "integer"}},
            },
        },
    }
    | documented(
        "malformed-request",
        "no-result",
        "payload-too-large",
        "unsupported-media-type",
        "too-many-requests",
        "queue-full",
        "insufficient-storage",
        *FIT_PROBLEMS,
    ),
)
async def make_product(
    fit: Found, request: Request, response: Response, context: Context, prefer: Prefer = None
) -> Product:
    """Have files made of a fit that has succeeded; `kind` says what.

    What was asked for before is answered with at once: of one fit the same is made once, unless it
    failed for another reason than the request. With `Prefer: wait=N` (at most 60 s) the answer
    waits for its end. A file comes along as a part of a form, whose part `request` is the JSON:
    `curl -F 'request={"kind": "size"}' -F chart=@chart.csv .../products`.
    """
    options, sent = await _read(request, context)
    if fit.state is not JobState.SUCCEEDED:
        raise ProblemError(no_result(fit))
    asked = product_id(options, None if sent is None else sent.content)
    with storing():
        submission = await run_in_threadpool(_submit, context, fit, asked, options, sent)
    product = accepted_job(submission)
    wait_s = preferred_wait_s(prefer)
    if wait_s > 0:
        look = partial(context.jobs.product, fit.id, asked)
        product = await wait_for_end(context, product, look, wait_s=wait_s)
        response.headers["Preference-Applied"] = f"wait={wait_s}"
    response.headers["Location"] = product_path(fit.id, asked)
    if product.state in ACTIVE:
        response.headers["Retry-After"] = str(POLL_AFTER_S)
    else:
        response.status_code = 200
    return await run_in_threadpool(_represented, context, product)


@ROUTER.get(
    "/{product_id}",
    response_model=Product,
    summary="Look at a product",
    responses=documented(*FIT_PROBLEMS),
)
def get_product(fit: Found, product_id: ProductId, response: Response, context: Context) -> Product:
    """Return where it stands, what there is to say of it, and its files."""
    product = _find(context, fit, product_id)
    if product.state in ACTIVE:
        response.headers["Retry-After"] = str(POLL_AFTER_S)
    return _represented(context, product)


@ROUTER.get(
    "/{product_id}/files/{name}",
    summary="A file of a product",
    description=f"Return a file: `body_reposed.glb` and so on, as `links.files` says.{NEGOTIATION}",
    response_class=Response,
    responses=file_answers(*_FILE_TYPES, problems=FIT_PROBLEMS),
)
async def get_product_file(
    fit: Found, product_id: ProductId, name: FileName, context: Context, wanted: Wanted
) -> Response:
    """Return a file, whole or in part."""
    product = await run_in_threadpool(_find, context, fit, product_id)
    rendition = chosen_rendition(
        product_files(product), name, state=product.state, accept=wanted.accept
    )
    return await answer_file(context, rendition, partial(stored_content, context, fit.id), wanted)


@dataclass(frozen=True, slots=True, kw_only=True)
class _Sent:
    """The part that came with a request."""

    name: str
    content: bytes
    media_type: str


async def _read(request: Request, context: ApiContext) -> tuple[AnyProductOptions, _Sent | None]:
    """Read the request: JSON, or a form with it and a file."""
    if media_type(request) == JSON:
        text, parts = await read_json_text(request), {}
        options = parsed(ProductRequest, text, whole="body", called="the body").root
    elif media_type(request) == MULTIPART:
        text, parts = await read_request_and_files(request, tuple(FORM_PARTS))
        options = parsed(ProductRequest, text, whole="request", called="the part 'request'").root
    else:
        raise unsupported(
            request,
            remedy=f"Send {JSON}, or {MULTIPART} with the parts 'request' and "
            f"{' or '.join(map(repr, FORM_PARTS))}.",
            accepted=f"{JSON}, {MULTIPART}",
        )
    return options, await run_in_threadpool(_checked, options, parts, context)


def _checked(
    options: AnyProductOptions, parts: Mapping[str, bytes], context: ApiContext
) -> _Sent | None:
    """Check the part that came along, beside the event loop."""
    taken = options.part
    for name in parts:
        if name != taken:
            raise refused(
                FieldProblem(
                    field=name,
                    code="unknown-field",
                    reason=f"This request for a product of kind {options.kind} takes no part "
                    f"'{name}'.",
                    remedy="Send the request without it.",
                )
            )
    if taken is None or taken not in parts:
        if options.part_is_for is not None:
            raise refused(
                FieldProblem(
                    field=taken or "kind",
                    code="missing",
                    reason=f"The part '{taken}' is missing, which {options.part_is_for}.",
                    remedy=f"Send {MULTIPART} with the parts 'request' and '{taken}'.",
                )
            )
        return None
    kind = FORM_PARTS[taken].check(
        parts[taken], options, max_pixels=context.settings.max_pixels, read=context.read_header
    )
    return _Sent(name=taken, content=parts[taken], media_type=kind)


def _submit(
    context: ApiContext,
    fit: JobRecord,
    asked: str,
    options: AnyProductOptions,
    sent: _Sent | None,
) -> Submission:
    """Have the product made unless it is there; its inputs are the fit's own files."""
    submissions = context.jobs.submissions
    room = submissions.room_for_product(fit.id, asked)
    if room.outcome is not SubmitOutcome.ACCEPTED:
        return room
    text = options.model_dump_json().encode()
    if not context.disk.has_room_for(len(text) + (0 if sent is None else len(sent.content))):
        raise disk_full()

    def stored(content: bytes, media_type: str) -> StoredBlob:
        return StoredBlob(digest=context.blobs.put(fit.id, content), media_type=media_type)

    part = {} if sent is None else {sent.name: stored(sent.content, sent.media_type)}
    job = NewJob(
        id=str(uuid4()),
        kind=options.kind,
        options=stored(text, JSON),
        inputs=product_inputs(fit.files) | part,
        request_id=context.request_id,
    )
    submission = submissions.submit_product(fit.id, asked, job)
    if submission.outcome is SubmitOutcome.FIT_GONE:
        # What was just stored came after the rest of its files was erased.
        erase_at_once(context.blobs, fit.id)
    return submission


def _find(context: ApiContext, fit: JobRecord, asked: str) -> JobRecord:
    product = context.jobs.product(fit.id, asked)
    if product is None:
        raise not_found(what="such product of this fit")
    return product


def _represented(context: ApiContext, product: JobRecord) -> Product:
    document = product.made.get(RESULT)
    result = None if document is None else stored_content(context, product.scope, document)
    return represent_product(product, result)
