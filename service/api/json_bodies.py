"""JSON bodies: read up to a limit, and parsed as one of the wire types."""

from typing import Any, Final, TypeVar

from fastapi import Request
from pydantic import BaseModel

from api_schemas.problems import problem
from service.api.problems import ProblemError
from service.submissions.refusal import parsed

JSON: Final = "application/json"
MAX_JSON_BYTES: Final = 1_000_000

Model = TypeVar("Model", bound=BaseModel)


def media_type(request: Request) -> str:
    """Return the declared media type of the body, in lower case, without parameters."""
    return request.headers.get("content-type", "").partition(";")[0].strip().lower()


def unsupported(request: Request, *, remedy: str, accepted: str) -> ProblemError:
    """Say that a body of this media type is not accepted here."""
    return ProblemError(
        problem(
            "unsupported-media-type",
            detail=f"The body is {media_type(request) or 'of no declared kind'}.",
            remedy=remedy,
        ),
        headers={"Accept-Post": accepted},
    )


async def read_json_text(request: Request) -> bytes:
    """Read a JSON body without looking into it.

    Raises
    ------
    ProblemError
        If it is declared as something else, or larger than any valid request.
    """
    if media_type(request) != JSON:
        raise unsupported(request, remedy=f"Send {JSON}.", accepted=JSON)
    text = b""
    async for chunk in request.stream():
        text += chunk
        if len(text) > MAX_JSON_BYTES:
            raise ProblemError(
                problem(
                    "payload-too-large",
                    detail=f"The JSON exceeds {MAX_JSON_BYTES} bytes.",
                    remedy="Send what /openapi.json describes for this path.",
                )
            )
    return text


async def read_json(request: Request, kind: type[Model]) -> Model:
    """Read a JSON body as a wire type.

    Raises
    ------
    ProblemError
        As :func:`read_json_text`.
    RefusedError
        If it is not JSON, or not of this type.
    """
    return parsed(kind, await read_json_text(request), whole="body", called="the body")


def json_body(kind: type[BaseModel]) -> dict[str, Any]:
    """Describe such a body for the OpenAPI document."""
    return {
        "requestBody": {
            "required": True,
            "content": {JSON: json_content(kind)},
        }
    }


def json_content(kind: type[BaseModel]) -> dict[str, Any]:
    """Describe JSON of a wire type, in a body or an answer."""
    return {"schema": {"$ref": f"#/components/schemas/{kind.__name__}"}}
