"""Questions about a picture that comes along or was uploaded before: read, and described."""

from typing import Any, Final, TypeVar

from fastapi import Request
from pydantic import BaseModel
from starlette.concurrency import run_in_threadpool

from api_schemas.images import ImageId
from service.api.context import ApiContext
from service.api.images import image_content
from service.api.json_bodies import JSON, json_content, media_type, read_json
from service.api.picture_forms import picture_form
from service.api.uploads import read_image_and_request
from service.submissions.validation import parsed

Asked = TypeVar("Asked", bound=BaseModel)

IMAGE_ID: Final = "image_id"


def question_body(asked: type[BaseModel], of_image: type[BaseModel]) -> dict[str, Any]:
    """Describe such a body: a form of picture and request, or JSON that names the picture."""
    return {
        "requestBody": {
            "required": True,
            "content": picture_form(asked) | {JSON: json_content(of_image)},
        }
    }


async def read_question(
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
