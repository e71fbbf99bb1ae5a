"""Questions that are answered at once: points of a picture, initial poses, and bodies."""

import base64
from collections.abc import Mapping
from enum import Enum
from typing import Annotated, Final, Literal

from fastapi import APIRouter, Query, Request, Response
from starlette.concurrency import run_in_threadpool

from api_schemas.csv_tables import CSV, measurements_csv
from api_schemas.questions import (
    BodyEstimate,
    BodyRequest,
    InitialPose,
    InitialPoseRequest,
    PointsProposal,
    PointsRequest,
)
from api_schemas.service import BodyModels
from service.api.context import Context
from service.api.files import BINARY, GLB, MESH_FORMATS
from service.api.images import image_content
from service.api.problems import ProblemError, documented, problem_error
from service.api.requests import (
    JSON,
    REQUEST,
    Part,
    body,
    form_content,
    json_content,
    json_part,
    read_json,
    read_json_or_form,
)
from service.api.storage import with_blobs
from service.compute import questions
from service.compute.questions import ANSWER, FILE, BodyTask
from service.jobs.inputs import IMAGE
from service.submissions.refusal import refused, refused_field
from service.submissions.submission import (
    checked_points,
    detector_is_installed,
    no_detector,
    placed_question,
    too_many_pixels,
)

ROUTER: Final = APIRouter()
ESTIMATES: Final[list[str | Enum]] = ["estimates"]

_PARTS: Final = {
    IMAGE: Part(description="JPEG, PNG, WebP or HEIC. None where it was uploaded."),
    REQUEST: json_part(PointsRequest, least=0),
}
BodyFormat = Annotated[Literal["json", "glb", "obj", "ply", "stl", "csv"], Query(alias="format")]
_BODIES: Final[Mapping[str, str]] = {
    "json": JSON,
    "glb": GLB,
    **MESH_FORMATS,
    "csv": CSV,
}
"""Media types of a body, by the names of formats."""


@ROUTER.post(
    "/v1/points",
    tags=ESTIMATES,
    response_class=Response,
    summary="Propose the points of a person, and check the picture",
    openapi_extra=body(form=form_content(_PARTS)),
    responses={
        200: {
            "description": "Who was found, the points of one of them, and what is wrong with the "
            "picture; nobody and a bad picture are no error.",
            "content": {JSON: json_content(PointsProposal)},
        }
    }
    | documented("not-found"),
)
async def propose_points(request: Request, context: Context) -> Response:
    """Return who is in a picture, where a detector sees their joints, and what is wrong with it.

    The picture comes along, or was uploaded to `/v1/images` before: then the request names it by
    `image_id`, and its JSON alone may be the body. `points` can be sent with a fit as they are;
    what is `doubtful` is better looked at first. Points that somebody moved are sent without
    `source`, or as clicks.

    Say in `view` from where the person is to be seen, and in `height_m` and the focal length what
    is known: how near the camera was follows from them.

    The detector is optional: where it is not installed only what known `points` tell is checked,
    and `not_checked` names the rest; without points the answer is a 404 whose code is
    `detector-not-installed`.
    """
    received = await read_json_or_form(request, PointsRequest, _PARTS)
    asked = received.asked
    if received.files:
        (image,) = received.files[IMAGE]
    elif asked.image_id is not None:
        image = await with_blobs(
            context.blobs, image_content, context, asked.image_id, field="image_id"
        )
    else:
        raise refused_field(
            field="image_id",
            code="missing",
            reason="The picture is missing.",
            remedy="Send the id of an uploaded picture, or a form with the part 'image'.",
        )
    settings = context.settings
    placed = await run_in_threadpool(
        placed_question, asked, image, max_pixels=settings.max_pixels, read=context.read_header
    )
    if not placed.points and not detector_is_installed(settings.detector_dir):
        raise ProblemError(no_detector())
    parts = await context.estimators.answer(questions.POINTS, placed, image)
    proposal = PointsProposal.model_validate_json(parts[ANSWER])
    if parts[FILE]:
        mask = base64.b64encode(parts[FILE]).decode()
        proposal = proposal.model_copy(update={"mask": mask})
    return Response(proposal.model_dump_json(), media_type=JSON)


@ROUTER.post(
    "/v1/initial-poses",
    tags=ESTIMATES,
    response_class=Response,
    summary="Pose a body by clicks alone",
    openapi_extra=body(json=json_content(InitialPoseRequest)),
    responses={200: {"model": InitialPose, "description": "The initial body, seen by its camera."}},
)
async def estimate_initial_pose(request: Request, context: Context) -> Response:
    """Return pose, camera and outline of the body a fit would begin from.

    With how far each click is from it, and the limbs of which the clicks do not say whether they
    come towards the camera: say so in `limb_facing`. The picture is not looked at: its size is
    needed, and its focal length, as the answer to its upload has it, if it is known.
    """
    asked = (await read_json(request, InitialPoseRequest)).asked
    size, most = asked.image_size, context.settings.max_pixels
    if size.width * size.height > most:
        raise refused(too_many_pixels("image_size", size.width, size.height, most))
    points = checked_points(asked.points, width=size.width, height=size.height)
    named = asked.model_copy(update={"points": points})
    parts = await context.estimators.answer(questions.INITIAL_POSE, named)
    return Response(parts[ANSWER], media_type=JSON)


@ROUTER.post(
    "/v1/bodies",
    tags=ESTIMATES,
    response_class=Response,
    summary="Estimate a body from measurements",
    openapi_extra=body(json=json_content(BodyRequest)),
    responses={
        200: {
            "description": "The most probable body, in the format that was asked for.",
            "content": dict.fromkeys(_BODIES.values(), BINARY) | {JSON: json_content(BodyEstimate)},
        }
    },
)
async def estimate_body(request: Request, context: Context, kind: BodyFormat = "json") -> Response:
    """Return the most probable body of a gender and of any known measurements.

    With its measurements, between which values 95 % of such people lie. `format` asks for the mesh,
    or with `csv` for the measurements as a table.
    """
    asked = (await read_json(request, BodyRequest)).asked
    task = BodyTask(request=asked, with_glb=kind not in ("json", "csv"))
    parts = await context.estimators.answer(questions.BODY, task)
    content = parts[FILE] if task.with_glb else parts[ANSWER]
    if kind in MESH_FORMATS:
        content = await context.estimators.convert(content, kind)
    elif kind == "csv":
        estimate = BodyEstimate.model_validate_json(content)
        content = measurements_csv(estimate.measurements)
    return Response(content, media_type=_BODIES[kind])


@ROUTER.get(
    "/v1/body-models",
    tags=["body models"],
    response_model=BodyModels,
    summary="The bodies there are",
)
def list_body_models(context: Context) -> BodyModels:
    """Return genders, mean heights, landmarks, accepted points, versions and provenance."""
    known = context.engine.body_models()
    if known is None:
        raise problem_error(
            slug="not-ready",
            detail="No worker has started yet, and only workers know the bodies.",
            remedy="Start a worker, or try again in a moment.",
        )
    return known
