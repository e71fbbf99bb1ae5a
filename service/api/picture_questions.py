"""Questions about a picture, answered at once: who is in it, and what is wrong with it."""

import base64
from typing import Any, Final

from fastapi import APIRouter, Request, Response
from starlette.concurrency import run_in_threadpool

from api_schemas.problems import FieldProblem
from api_schemas.questions import PointsProposal, PointsRequest
from service.api.context import ApiContext, Context
from service.api.estimates import ESTIMATE_PROBLEMS
from service.api.images import image_content
from service.api.json_bodies import JSON, json_content, media_type, read_json
from service.api.problems import ProblemError, documented
from service.api.uploads import picture_form, read_image_and_request
from service.submissions.refusal import parsed, refused
from service.submissions.submission import detector_is_installed, no_detector, placed_question

ROUTER: Final = APIRouter(tags=["estimates"])

_BODY: Final[dict[str, Any]] = {
    "requestBody": {
        "required": True,
        "content": picture_form(PointsRequest) | {JSON: json_content(PointsRequest)},
    }
}
_PROPOSED: Final[dict[int | str, dict[str, Any]]] = {
    200: {
        "description": "Who was found, the points of one of them, and what is wrong with the "
        "picture; nobody and a bad picture are no error.",
        "content": {JSON: json_content(PointsProposal)},
    }
}


@ROUTER.post(
    "/v1/points",
    response_class=Response,
    summary="Propose the points of a person, and check the picture",
    openapi_extra=_BODY,
    responses=_PROPOSED | documented("not-found", *ESTIMATE_PROBLEMS),
)
async def propose_points(request: Request, context: Context) -> Response:
    """Return who is in a picture, where a detector sees their joints, and what is wrong with it.

    The picture comes along, or was uploaded to `/v1/images` before: then the body is JSON and names
    it by `image_id`. `points` can be sent with a fit as they are; what is `doubtful` is better
    looked at first. Points that somebody moved are sent without `source`, or as clicks.

    Say in `view` from where the person is to be seen, and in `height_m` and the focal length what
    is known: how near the camera was follows from them.

    The detector is optional: where it is not installed only what known `points` tell is checked,
    and `not_checked` names the rest; without points the answer is a 404 whose code is
    `detector-not-installed`.
    """
    asked, image = await _read(request, context)
    placed = await run_in_threadpool(
        placed_question,
        asked,
        image,
        max_pixels=context.settings.max_pixels,
        read=context.read_header,
    )
    if not placed.points and not detector_is_installed(context.settings.detector_dir):
        raise ProblemError(no_detector())
    proposed = await context.estimates.points(placed, image)
    answer = proposed.proposal
    if proposed.mask:
        mask = base64.b64encode(proposed.mask).decode()
        answer = answer.model_copy(update={"mask": mask})
    text = answer.model_dump_json()
    return Response(text, media_type=JSON, headers={"Cache-Control": "no-store"})


async def _read(request: Request, context: ApiContext) -> tuple[PointsRequest, bytes]:
    """Read what is asked, and the picture.

    Raises
    ------
    ProblemError
        As :func:`service.api.uploads.read_image_and_request` and
        :func:`service.api.json_bodies.read_json_text`.
    RefusedError
        If the request is not of its type, or there is no such picture.
    """
    if media_type(request) == JSON:
        asked = await read_json(request, PointsRequest)
        if asked.image_id is None:
            raise refused(
                FieldProblem(
                    field="image_id",
                    code="missing",
                    reason="The picture is missing.",
                    remedy="Send the id of an uploaded picture, or a form with the part 'image'.",
                )
            )
        return asked, await run_in_threadpool(
            image_content, context, asked.image_id, field="image_id"
        )
    image, text = await read_image_and_request(request)
    return parsed(PointsRequest, text, whole="request", called="the part 'request'"), image
