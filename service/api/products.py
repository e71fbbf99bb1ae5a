"""Products of a fit: ask for one, look at it, read its files.

They lie below their fit and in its storage: whoever may see the fit may see them, and once it is
gone so are they.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Annotated, Final
from uuid import UUID, uuid4

from fastapi import APIRouter, Path, Request, Response
from starlette.concurrency import run_in_threadpool

from api_schemas.jobs import JobState
from api_schemas.problems import problem
from api_schemas.products import (
    AnyProductOptions,
    Product,
    ProductLinks,
    ProductRequest,
    product_id,
    product_result,
)
from api_schemas.products.base import ProductKind
from api_schemas.products.bodies import AnimationOptions
from api_schemas.products.documents import (
    MAX_CHART_BYTES,
    NOT_A_CHART,
    ChartError,
    SizeOptions,
    ease_faults,
    read_chart,
)
from fitter.applications.bvh import MAX_BYTES
from fitter.applications.motion_file import read_motion
from fitter.errors import InvalidInputError
from service.api.context import ApiContext, Context
from service.api.events import Prefer, wait_for_end
from service.api.files import FORMATS, FileName, Wanted, answer_file, chosen_rendition, file_answers
from service.api.fits import (
    FIT_PROBLEMS,
    FITS,
    POLL_AFTER_S,
    Found,
    fit_path,
    no_result,
)
from service.api.problems import ProblemError, documented, not_found
from service.api.requests import (
    JSON,
    MULTIPART,
    REQUEST,
    Part,
    body,
    form_content,
    json_content,
    json_part,
    read_json_or_form,
)
from service.api.storage import disk_full, erase_at_once, store, stored_content, storing, with_blobs
from service.api.submissions import TO_FOLLOW, accepted_job
from service.jobs.inputs import CHART, CLIP, RESULT, product_inputs
from service.jobs.records import ACTIVE, JobRecord, NewJob, StoredBlob, Submission, SubmitOutcome
from service.submissions.refusal import RefusedError, refused, refused_field

PRODUCTS: Final = "products"
"""Path of products below their fit."""

ROUTER: Final = APIRouter(prefix=f"{FITS}/{{fit_id}}/{PRODUCTS}", tags=["products"])

_PARTS: Final = {
    REQUEST: json_part(ProductRequest),
    CLIP: Part(
        description="A motion as a BVH file. Joints are known by the names of many programs, such "
        "as CMU, Mixamo, Biovision, SMPL or Unreal; `joints` names them otherwise. Its rest pose "
        "does not matter.",
        media_types="text/plain, application/octet-stream",
    ),
    CHART: Part(
        description="A size chart as CSV: a header `size,chest_girth,waist_girth_navel` with the "
        "names of measurements, then a row for each size, `M,94-98,80-84`, in centimetres.",
        media_types="text/csv, text/plain, application/octet-stream",
    ),
}

_FILE_TYPES: Final = ("image/jpeg", "image/png", "image/webp", "text/html")
"""The kinds of files that are neither meshes nor JSON."""

ProductId = Annotated[str, Path(pattern="^[0-9a-f]{32}$")]


@ROUTER.post(
    "",
    status_code=202,
    response_model=Product,
    summary="Ask for a product",
    openapi_extra=body(json=json_content(ProductRequest), form=form_content(_PARTS)),
    responses={
        200: {"model": Product, "description": "It is there, or making it has failed."},
        202: {"description": "It is being made.", "headers": TO_FOLLOW},
    }
    | documented("no-result", "insufficient-storage", *FIT_PROBLEMS),
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
    received = await read_json_or_form(request, ProductRequest, _PARTS)
    options = received.asked.root
    sent = await run_in_threadpool(_checked, options, received.files)
    if fit.state is not JobState.SUCCEEDED:
        raise ProblemError(no_result(fit))
    asked = product_id(options, None if sent is None else sent.content)
    with storing():
        submission = await with_blobs(context.blobs, _submit, context, fit, asked, options, sent)
    product = accepted_job(submission)
    look = partial(context.jobs.product, fit.id, asked)
    product = await wait_for_end(
        context.feed, context.tenant, product, look, prefer=prefer, response=response
    )
    response.headers["Location"] = _path(fit.id, asked)
    if product.state in ACTIVE:
        response.headers["Retry-After"] = str(POLL_AFTER_S)
    else:
        response.status_code = 200
    return await _represented(context, product)


@ROUTER.get(
    "/{product_id}",
    response_model=Product,
    summary="Look at a product",
    responses=documented(*FIT_PROBLEMS),
)
async def get_product(
    fit: Found, product_id: ProductId, response: Response, context: Context
) -> Product:
    """Return where it stands, what there is to say of it, and its files."""
    product = await run_in_threadpool(_find, context, fit, product_id)
    if product.state in ACTIVE:
        response.headers["Retry-After"] = str(POLL_AFTER_S)
    return await _represented(context, product)


@ROUTER.get(
    "/{product_id}/files/{name}",
    summary="A file of a product",
    description=f"Return a file: `body_reposed.glb` and so on, as `links.files` says.{FORMATS}",
    response_class=Response,
    responses=file_answers(*_FILE_TYPES, problems=FIT_PROBLEMS),
)
async def get_product_file(
    fit: Found, product_id: ProductId, name: FileName, context: Context, wanted: Wanted
) -> Response:
    """Return a file."""
    product = await run_in_threadpool(_find, context, fit, product_id)
    rendition = chosen_rendition(_files(product), name, state=product.state, accept=wanted.accept)
    return await answer_file(context, fit.id, rendition, wanted)


@dataclass(frozen=True, slots=True, kw_only=True)
class _Sent:
    """The part that came with a request."""

    name: str
    content: bytes
    media_type: str


def _checked(options: AnyProductOptions, parts: Mapping[str, Sequence[bytes]]) -> _Sent | None:
    """Check the part that came along, beside the event loop."""
    taken = options.part
    for name in parts:
        if name != taken:
            raise refused_field(
                field=name,
                code="unknown-field",
                reason=f"This request for a product of kind {options.kind} takes no part '{name}'.",
                remedy="Send the request without it.",
            )
    if taken is None or taken not in parts:
        if options.part_is_for is not None:
            raise refused_field(
                field=taken or "kind",
                code="missing",
                reason=f"The part '{taken}' is missing, which {options.part_is_for}.",
                remedy=f"Send {MULTIPART} with the parts 'request' and '{taken}'.",
            )
        return None
    (content,) = parts[taken]
    kind = _CHECKS[taken](content, options)
    return _Sent(name=taken, content=content, media_type=kind)


def _check_motion(clip: bytes, options: AnyProductOptions) -> str:
    """Read a BVH file: what cannot be made of it is refused now, in the same words."""
    if len(clip) > MAX_BYTES:
        raise RefusedError(
            problem(
                "payload-too-large",
                field=CLIP,
                detail=f"The motion has {len(clip)} bytes, more than {MAX_BYTES}.",
                remedy="Cut the clip, or lower its frame rate.",
            )
        )
    if isinstance(options, AnimationOptions):
        try:
            read_motion(clip, named=options.joints, start_s=options.start_s)
        except InvalidInputError as error:
            raise refused_field(
                field=error.field, code=error.code, reason=error.reason, remedy=error.remedy
            ) from error
    return "text/plain"


def _check_chart(chart: bytes, options: AnyProductOptions) -> str:
    """Read the chart; returns its media type."""
    if len(chart) > MAX_CHART_BYTES:
        raise RefusedError(
            problem(
                "payload-too-large",
                field=CHART,
                detail=f"The chart has {len(chart)} bytes, more than {MAX_CHART_BYTES}.",
                remedy="Send the sizes of one garment alone.",
            )
        )
    try:
        read = read_chart(chart)
    except ChartError as error:
        raise refused_field(
            field=CHART, code=NOT_A_CHART, reason=str(error), remedy=error.remedy
        ) from error
    assert isinstance(options, SizeOptions)
    faults = ease_faults(options, read)
    if faults:
        raise refused(*faults)
    return "text/csv"


_CHECKS: Final[Mapping[str, Callable[[bytes, AnyProductOptions], str]]] = {
    CLIP: _check_motion,
    CHART: _check_chart,
}
"""Each is given a file and what is asked for, and returns the file's media type."""


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

    stored = partial(store, context.blobs, fit.id)
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


def _path(fit_id: str, product_id: str) -> str:
    """Path of a product below the service's root."""
    return f"{fit_path(fit_id)}/{PRODUCTS}/{product_id}"


def _files(record: JobRecord) -> dict[str, StoredBlob]:
    """The files that were made, without what there is to say of them."""
    return {name: file for name, file in record.made.items() if name != RESULT}


async def _represented(context: ApiContext, record: JobRecord) -> Product:
    """Translate a record, with what there is to say of the product once it is made."""
    assert record.parent is not None
    assert record.product is not None
    path = _path(record.parent, record.product)
    done = record.state is JobState.SUCCEEDED
    result = None
    if RESULT in record.made:
        document = await stored_content(context.blobs, record.scope, record.made[RESULT])
        result = product_result(document)
    return Product(
        id=record.product,
        kind=ProductKind(record.kind),
        fit_id=UUID(record.parent),
        state=record.state,
        progress=record.progress,
        problem=record.problem,
        result=result,
        links=ProductLinks(
            self=path,
            fit=fit_path(record.parent),
            files={name: f"{path}/files/{name}" for name in _files(record)} if done else {},
        ),
    )
