"""Questions about a picture, answered at once: who is in it (points), what is wrong (checks).

The picture comes along or was uploaded before.
"""

import base64
from typing import Any, Final, TypeVar

from fastapi import APIRouter, Request, Response
from pydantic import BaseModel
from starlette.concurrency import run_in_threadpool

from api_schemas.checks import CaptureCheck, CheckOfImage, CheckRequest
from api_schemas.images import ImageId
from api_schemas.proposals import PointsOfImage, PointsProposal, PointsRequest
from service.api.context import ApiContext, Context
from service.api.estimates import ESTIMATE_PROBLEMS
from service.api.images import image_content
from service.api.json_bodies import JSON, json_content, media_type, read_json
from service.api.problems import ProblemError, documented
from service.api.uploads import picture_form, read_image_and_request
from service.submissions.detector import detector_is_installed, no_detector
from service.submissions.submission import check_picture, placed_question
from service.submissions.validation import parsed

Asked = TypeVar("Asked", bound=BaseModel)

ROUTER: Final = APIRouter(tags=["estimates"])

IMAGE_ID: Final = "image_id"


_PROPOSED: Final[dict[int | str, dict[str, Any]]] = {
    200: {
        "description": "Who was found, and the points of one of them; nobody is no error.",
        "content": {JSON: json_content(PointsProposal)},
    }
}

_CHECKED: Final[dict[int | str, dict[str, Any]]] = {
    200: {
        "description": "What is wrong with the picture; a bad one is no error.",
        "content": {JSON: json_content(CaptureCheck)},
    }
}


def _body(asked: type[BaseModel], of_image: type[BaseModel]) -> dict[str, Any]:
    """Describe a question's body: a form of picture and request, or JSON that names the picture."""
    return {
        "requestBody": {
            "required": True,
            "content": picture_form(asked) | {JSON: json_content(of_image)},
        }
    }


@ROUTER.post(
    "/v1/points",
    response_class=Response,
    summary="Propose the points of a person",
    openapi_extra=_body(PointsRequest, PointsOfImage),
    responses=_PROPOSED | documented("not-found", *ESTIMATE_PROBLEMS),
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
        raise ProblemError(no_detector())
    asked, image = await _read(request, context, PointsRequest, PointsOfImage)
    await run_in_threadpool(_check_picture, context, image)
    proposed = await context.estimates.points(asked, image)
    answer = proposed.proposal
    if proposed.mask:
        mask = base64.b64encode(proposed.mask).decode()
        answer = answer.model_copy(update={"mask": mask})
    text = answer.model_dump_json()
    return Response(text, media_type=JSON, headers={"Cache-Control": "no-store"})


def _check_picture(context: ApiContext, image: bytes) -> None:
    check_picture("image", image, max_pixels=context.settings.max_pixels)


@ROUTER.post(
    "/v1/checks",
    response_class=Response,
    summary="Check a picture before it is fitted",
    openapi_extra=_body(CheckRequest, CheckOfImage),
    responses=_CHECKED | documented("not-found", *ESTIMATE_PROBLEMS),
)
async def check_capture(request: Request, context: Context) -> Response:
    """Return what is wrong with a picture, each with what was measured and what to do about it.

    The picture comes along, or was uploaded to `/v1/images` before: then the body is JSON and names
    it by `image_id`. Say in `view` from where the person is to be seen, and in `height_m` and the
    focal length what is known: how near the camera was follows from them.

    Where no detector is installed, only what points tell is checked, and `not_checked` names the
    rest; without points the answer is a 404 whose code is `detector-not-installed`.
    """
    asked, image = await _read(request, context, CheckRequest, CheckOfImage)
    placed = await run_in_threadpool(
        placed_question, asked, image, max_pixels=context.settings.max_pixels
    )
    if not placed.points and not detector_is_installed(context.settings.detector_dir):
        raise ProblemError(no_detector())
    check = await context.estimates.check(placed, image)
    return Response(check.model_dump_json(), media_type=JSON, headers={"Cache-Control": "no-store"})


async def _read(
    request: Request, context: ApiContext, asked: type[Asked], of_image: type[BaseModel]
) -> tuple[Asked, bytes]:
    """Read what is asked, and the picture.

    Parameters
    ----------
    asked, of_image
        The request, and the same with the field ``image_id``.

    Raises
    ------
    ProblemError
        As :func:`service.api.uploads.read_image_and_request` and
        :func:`service.api.json_bodies.read_json_text`.
    RefusedError
        If the request is not of its type, or there is no such picture.
    """
    if media_type(request) == JSON:
        named = await read_json(request, of_image)
        image_id: ImageId = getattr(named, IMAGE_ID)
        image = await run_in_threadpool(image_content, context, image_id, field=IMAGE_ID)
        known = {name: getattr(named, name) for name in asked.model_fields}
        return asked.model_construct(**known), image
    image, text = await read_image_and_request(request)
    return parsed(asked, text, whole="request", called="the part 'request'"), image
