"""Complete the generated OpenAPI document: what FastAPI cannot know of our types."""

from typing import Any

from pydantic.json_schema import models_json_schema

from api_schemas.base import WireModel
from api_schemas.bodies import BodyEstimate, BodyRequest
from api_schemas.images import UploadedImage
from api_schemas.initial_poses import InitialPose, InitialPoseRequest
from api_schemas.jobs import EventData
from api_schemas.problems import PROBLEM_MEDIA_TYPE, Problem
from api_schemas.requests import FitOfImage, FitOptions
from service.api.problems import documented

_ANSWERED_EVERYWHERE = {
    str(status): answer
    for status, answer in documented(
        "unauthorized", "forbidden", "method-not-allowed", "too-many-requests"
    ).items()
}

_KEY_SCHEME = "apiKey"
_SECURITY: dict[str, Any] = {
    "securitySchemes": {
        _KEY_SCHEME: {
            "type": "http",
            "scheme": "bearer",
            "description": "An API key, where the service asks for one "
            "(`MAQUETTE_AUTHENTICATION=keys`).",
        }
    }
}


def complete_openapi(document: dict[str, Any]) -> dict[str, Any]:
    """Add the types that are only referred to, and drop FastAPI's own error format."""
    schemas: dict[str, Any] = document.setdefault("components", {}).setdefault("schemas", {})
    for mode in ("validation", "serialization"):
        _, extra = models_json_schema(
            [(model, mode) for model in _models(mode)],
            ref_template="#/components/schemas/{model}",
        )
        for name, schema in extra.get("$defs", {}).items():
            schemas.setdefault(name, schema)
    for path in document["paths"].values():
        for operation in path.values():
            if _is_fastapi_error(operation):
                del operation["responses"]["422"]
            operation["responses"] = _ANSWERED_EVERYWHERE | operation["responses"]
    for name in ("HTTPValidationError", "ValidationError"):
        schemas.pop(name, None)
    document["components"]["schemas"] = dict(sorted(schemas.items()))
    document["components"] |= _SECURITY
    # With a key or without: which of the two, the service's settings say.
    document["security"] = [{_KEY_SCHEME: []}, {}]
    return document


def _models(mode: str) -> tuple[type[WireModel], ...]:
    if mode == "validation":
        return (FitOptions, FitOfImage, BodyRequest, InitialPoseRequest)
    return (Problem, EventData, BodyEstimate, InitialPose, UploadedImage)


def _is_fastapi_error(operation: dict[str, Any]) -> bool:
    content = operation["responses"].get("422", {}).get("content", {})
    return "422" in operation["responses"] and PROBLEM_MEDIA_TYPE not in content
