"""Points proposed at once: for a front end to show and have corrected, or to send with a fit."""

import base64
from typing import Any, Final

from fastapi import APIRouter, Request, Response
from starlette.concurrency import run_in_threadpool

from api_schemas.proposals import PointsOfImage, PointsProposal, PointsRequest
from service.api.context import ApiContext, Context
from service.api.estimates import ESTIMATE_PROBLEMS, no_detector
from service.api.json_bodies import JSON, json_content
from service.api.picture_questions import question_body, read_question
from service.api.problems import documented
from service.estimates.messages import PointsTask
from service.submissions.detector import detector_is_installed
from service.submissions.submission import check_picture

ROUTER: Final = APIRouter(prefix="/v1/points", tags=["estimates"])

_ANSWER: Final[dict[int | str, dict[str, Any]]] = {
    200: {
        "description": "Who was found, and the points of one of them; nobody is no error.",
        "content": {JSON: json_content(PointsProposal)},
    }
}


@ROUTER.post(
    "",
    response_class=Response,
    summary="Propose the points of a person",
    openapi_extra=question_body(PointsRequest, PointsOfImage),
    responses=_ANSWER | documented("not-found", *ESTIMATE_PROBLEMS),
)
async def propose_points(request: Request, context: Context) -> Response:
    """Return who is in a picture, and where a detector sees the joints of one of them.

    The picture comes along, or was uploaded to `/v1/images` before: then the body is JSON and names
    it by `image_id`. `points` can be sent with a fit as they are; what is `doubtful` is better
    looked at first. Points that somebody moved are sent without `source`, or as clicks.

    The detector is optional: where it is not installed the answer is a 404 whose code is
    `detector-not-installed`.
    """
    if not detector_is_installed(context.settings.detector_dir):
        raise no_detector()
    asked, image = await read_question(request, context, PointsRequest, PointsOfImage)
    await run_in_threadpool(_check_picture, context, image)
    proposed = await context.estimates.points(PointsTask(request=asked), image)
    answer = proposed.proposal
    if proposed.mask:
        mask = base64.b64encode(proposed.mask).decode()
        answer = answer.model_copy(update={"mask": mask})
    text = answer.model_dump_json()
    return Response(text, media_type=JSON, headers={"Cache-Control": "no-store"})


def _check_picture(context: ApiContext, image: bytes) -> None:
    check_picture("image", image, max_pixels=context.settings.max_pixels)
