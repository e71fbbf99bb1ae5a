"""The body a fit would start from, at once: for a front end to show while points are clicked."""

from typing import Any, Final

from fastapi import APIRouter, Request, Response
from starlette.concurrency import run_in_threadpool

from api_schemas.points import PointsFormat
from api_schemas.problems import FieldProblem
from api_schemas.questions import ImageSize, InitialPose, InitialPoseRequest
from service.api.context import ApiContext, Context
from service.api.estimates import ESTIMATE_PROBLEMS
from service.api.images import known_image
from service.api.json_bodies import JSON, json_body, json_content, read_json
from service.api.problems import documented
from service.estimates.questions import InitialPoseTask
from service.submissions.refusal import refused
from service.submissions.submission import checked_points

ROUTER: Final = APIRouter(prefix="/v1/initial-poses", tags=["estimates"])

_ANSWER: Final[dict[int | str, dict[str, Any]]] = {
    200: {
        "description": "The initial body, seen by its camera.",
        "content": {JSON: json_content(InitialPose)},
    }
}


@ROUTER.post(
    "",
    response_class=Response,
    summary="Pose a body by clicks alone",
    openapi_extra=json_body(InitialPoseRequest),
    responses=_ANSWER | documented(*ESTIMATE_PROBLEMS),
)
async def estimate_initial_pose(request: Request, context: Context) -> Response:
    """Return pose, camera and outline of the body a fit would begin from.

    With how far each click is from it, and the limbs of which the clicks do not say whether they
    come towards the camera: say so in `limb_facing`. The picture is not looked at; its size is
    needed, and the focal length its EXIF data name if it was uploaded.
    """
    asked = await read_json(request, InitialPoseRequest)
    size, exif_focal_length_35mm = await _picture(context, asked)
    points = checked_points(asked.points, asked.format, width=size.width, height=size.height)
    pose = await context.estimates.initial_pose(
        InitialPoseTask(
            subject=asked.model_copy(update={"points": points, "format": PointsFormat.NAMED}),
            width=size.width,
            height=size.height,
            exif_focal_length_35mm=exif_focal_length_35mm,
        )
    )
    return Response(pose.model_dump_json(), media_type=JSON, headers={"Cache-Control": "no-store"})


async def _picture(
    context: ApiContext, asked: InitialPoseRequest
) -> tuple[ImageSize, float | None]:
    """The picture's size and the 35 mm equivalent it records, if known."""
    if asked.image_id is not None:
        record = await run_in_threadpool(known_image, context, asked.image_id, field="image_id")
        return ImageSize(width=record.width, height=record.height), record.focal_length_35mm
    size = asked.image_size
    assert size is not None, "the type wants exactly one of the two"
    if size.width * size.height > context.settings.max_pixels:
        raise refused(
            FieldProblem(
                field="image_size",
                code="image-too-large",
                reason=(
                    f"The picture has {size.width} x {size.height} pixels, more than the "
                    f"{context.settings.max_pixels} this service accepts."
                ),
                remedy="Scale the picture down; 1500 pixels on the longer side are plenty.",
            )
        )
    return size, None
