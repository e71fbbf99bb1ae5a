"""Checks of a picture at once: for a guide that says what to change before the next one."""

from typing import Any, Final

from fastapi import APIRouter, Request, Response
from starlette.concurrency import run_in_threadpool

from api_schemas.checks import CaptureCheck, CheckOfImage, CheckRequest
from service.api.context import Context
from service.api.estimates import ESTIMATE_PROBLEMS, no_detector
from service.api.json_bodies import JSON, json_content
from service.api.picture_questions import question_body, read_question
from service.api.problems import documented
from service.estimates.messages import CheckTask
from service.submissions.capture_questions import placed_question
from service.submissions.detector import detector_is_installed

ROUTER: Final = APIRouter(prefix="/v1/checks", tags=["estimates"])

_ANSWER: Final[dict[int | str, dict[str, Any]]] = {
    200: {
        "description": "What is wrong with the picture; a bad one is no error.",
        "content": {JSON: json_content(CaptureCheck)},
    }
}


@ROUTER.post(
    "",
    response_class=Response,
    summary="Check a picture before it is fitted",
    openapi_extra=question_body(CheckRequest, CheckOfImage),
    responses=_ANSWER | documented("not-found", *ESTIMATE_PROBLEMS),
)
async def check_capture(request: Request, context: Context) -> Response:
    """Return what is wrong with a picture, each with what was measured and what to do about it.

    The picture comes along, or was uploaded to `/v1/images` before: then the body is JSON and names
    it by `image_id`. Say in `view` from where the person is to be seen, and in `height_m` and the
    focal length what is known: how near the camera was follows from them.

    Where no detector is installed, only what points tell is checked, and `not_checked` names the
    rest; without points the answer is a 404 whose code is `detector-not-installed`.
    """
    asked, image = await read_question(request, context, CheckRequest, CheckOfImage)
    placed = await run_in_threadpool(
        placed_question, asked, image, max_pixels=context.settings.max_pixels
    )
    if not placed.points and not detector_is_installed(context.settings.detector_dir):
        raise no_detector()
    check = await context.estimates.check(CheckTask(request=placed), image)
    return Response(check.model_dump_json(), media_type=JSON, headers={"Cache-Control": "no-store"})
