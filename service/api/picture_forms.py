"""Describe forms with a picture for the OpenAPI document."""

from typing import Any, Final

from pydantic import BaseModel

from service.api.json_bodies import JSON, json_content
from service.api.uploads import MULTIPART

_PICTURE: Final = {"type": "string", "format": "binary", "description": "JPEG, PNG, WebP or HEIC."}
_PICTURE_TYPES: Final = {"contentType": "image/jpeg, image/png, image/webp, image/heic"}


def picture_form(asked: type[BaseModel] | None = None) -> dict[str, Any]:
    """Content of a body with the part ``image``, and with an optional ``request`` of that type."""
    properties: dict[str, Any] = {"image": dict(_PICTURE)}
    encoding: dict[str, Any] = {"image": dict(_PICTURE_TYPES)}
    if asked is not None:
        properties["request"] = json_content(asked)["schema"]
        encoding["request"] = {"contentType": JSON}
    return {
        MULTIPART: {
            "schema": {
                "type": "object",
                "additionalProperties": False,
                "required": ["image"],
                "properties": properties,
            },
            "encoding": encoding,
        }
    }
