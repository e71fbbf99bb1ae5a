"""Complete the generated OpenAPI document: what FastAPI cannot know of our types."""

import json
import re
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from functools import cache
from importlib.resources import files
from typing import Any, Final, Literal, cast

from pydantic import BaseModel
from pydantic.json_schema import models_json_schema

from api_schemas.fit import MOST_VIEWS, FitRequest
from api_schemas.jobs import EventData, WebhookEvent
from api_schemas.picture import LARGEST_ASPECT_RATIO, LEAST_SIDE_PX
from api_schemas.problems import Problem
from api_schemas.products import ProductRequest
from api_schemas.products.bodies import TEXTURE_SIZES
from api_schemas.questions import (
    BodyEstimate,
    BodyRequest,
    InitialPoseRequest,
    PointsProposal,
    PointsRequest,
)
from fitter.vocabulary.measurements import (
    CHIEF,
    LEAST_HEIGHT_M,
    MEASUREMENT_UNITS,
    MOST_HEIGHT_M,
    Group,
    group_of,
)
from fitter.vocabulary.points import (
    CLEAR_BREADTH,
    LIMB_POINT_NAMES,
    MIN_EXTENT,
    MIN_LIMB_POINTS,
    MIN_TRUNK_POINTS,
    POINT_NAMES,
    TRUNK_POINT_NAMES,
)
from service.api.problems import documented, documented_responses
from service.api.requests import JSON, MULTIPART, REQUEST, json_content

SUMMARY: Final = "Human body shape, pose, light and measurements from a single picture."

DESCRIPTION: Final = """\
One to six pictures of a person are posted to `/v1/fits`; the answer is a fit, which is followed \
by its events or looked at now and then. Once it has succeeded, its result and its files are below \
it, and more can be made of it (products). Points, initial poses and bodies are answered at once.

Every error is `application/problem+json` and says which field, why, and what to do about it."""

LICENCE: Final[Mapping[str, str]] = {"name": "Apache License 2.0", "identifier": "Apache-2.0"}

TAGS: Final[Sequence[Mapping[str, str]]] = (
    {"name": "fits", "description": "Bodies fitted to one to six pictures, and their files."},
    {"name": "products", "description": "Files that are made of a fit when they are asked for."},
    {"name": "images", "description": "Pictures that are uploaded once, for any number of fits."},
    {"name": "estimates", "description": "Points, initial poses and bodies, answered at once."},
    {"name": "body models", "description": "The bodies that are fitted."},
    {"name": "health", "description": "Whether the service is up, and its figures."},
    {"name": "problems", "description": "What the types of errors mean."},
)

SERVERS: Final[Sequence[Mapping[str, Any]]] = (
    {"url": "/", "description": "The service that this document was fetched from."},
)


Examples = Mapping[str, Any]
"""Values by their names."""

ANSWERED_EVERYWHERE: Final = documented(
    "unauthorized",
    "forbidden",
    "method-not-allowed",
    "request-timeout",
    "invalid-request",
    "too-many-requests",
    "internal-error",
    "not-ready",
)
"""Problems of any request; an operation names those of its own."""

_KEY_SCHEME = "apiKey"
_SECURITY: Final = {
    _KEY_SCHEME: {
        "type": "http",
        "scheme": "bearer",
        "description": "An API key, where the service asks for one "
        "(`MAQUETTE_AUTHENTICATION=keys`).",
    }
}

_MODELS: Final[Mapping[Literal["validation", "serialization"], Sequence[type[BaseModel]]]] = {
    "validation": (FitRequest, ProductRequest, BodyRequest, InitialPoseRequest, PointsRequest),
    "serialization": (Problem, EventData, BodyEstimate, PointsProposal, WebhookEvent),
}
"""Requests, and answers that FastAPI does not know by an operation."""

_REFERENCE: Final = re.compile(r'"#/components/schemas/(\w+)"')


@cache
def recorded_examples() -> Mapping[str, Any]:
    """Return what a service was asked and what it answered, notices included.

    By operation, status and name; ``tests/contract/recording.py`` has recorded it.
    """
    return json.loads((files("service.api") / "examples.json").read_bytes())


def _notice() -> dict[str, Any]:
    """Describe the notice of the end of a fit."""
    example = recorded_examples()["notices"]["fit-ended"]
    content = {JSON: json_content(WebhookEvent) | {"examples": {"succeeded": {"value": example}}}}
    return {
        "post": {
            "summary": "A fit has ended",
            "description": (
                "Sent where the request's `webhook` says, signed as Standard Webhooks has it: "
                "`webhook-signature` is `v1,` and the base64 HMAC-SHA256 of "
                "`{webhook-id}.{webhook-timestamp}.{body}` by the secret's bytes. It is sent again "
                "until it is accepted, always with the same id and body: whoever receives it may "
                "get it more than once."
            ),
            "operationId": "fit_ended",
            "requestBody": {"required": True, "content": content},
            "responses": {
                "2XX": {"description": "Accepted."},
                "410": {"description": "Not wanted: given up at once."},
                "default": {"description": "Sent again later; redirects are not followed."},
            },
        }
    }


_LIMITS: dict[str, Any] = {
    "description": (
        "Limits of several fields together, for clients that check before they send, and the names "
        "of points and measurements."
    ),
    "points": {
        "names": POINT_NAMES,
        "limb_names": LIMB_POINT_NAMES,
        "trunk_names": TRUNK_POINT_NAMES,
        "least_limb_points": MIN_LIMB_POINTS,
        "least_trunk_points": MIN_TRUNK_POINTS,
        "least_extent": MIN_EXTENT,
        "clear_breadth": CLEAR_BREADTH,
    },
    "measurements": {
        "chief": CHIEF,
        "groups": {
            group.name.lower(): [name for name in MEASUREMENT_UNITS if group_of(name) is group]
            for group in Group
        },
    },
    "height_m": {"least": LEAST_HEIGHT_M, "most": MOST_HEIGHT_M},
    "texture_sizes": TEXTURE_SIZES,
    "picture": {"least_side": LEAST_SIDE_PX, "largest_aspect_ratio": LARGEST_ASPECT_RATIO},
    "views": {"most": MOST_VIEWS},
}


def complete_openapi(document: dict[str, Any]) -> dict[str, Any]:
    """Add the types that are only referred to, and drop FastAPI's own error format."""
    schemas: dict[str, Any] = document["components"]["schemas"]
    for mode, models in _MODELS.items():
        _, extra = models_json_schema(
            [(model, mode) for model in models], ref_template="#/components/schemas/{model}"
        )
        for name, schema in extra.get("$defs", {}).items():
            schemas.setdefault(name, schema)
    for path in document["paths"].values():
        for operation in path.values():
            _complete_operation(operation)
    document["webhooks"] = {"fit-ended": _notice()}
    document["x-limits"] = _LIMITS
    _tell_defaults(schemas)
    _drop_titles(schemas)
    document |= _plain(document, _named_once(document))
    document["components"] = {
        "schemas": dict(sorted(document["components"]["schemas"].items())),
        "securitySchemes": _SECURITY,
        "responses": documented_responses(json.dumps(document["paths"])),
    }
    # With a key or without: which of the two, the service's settings say.
    document["security"] = [{_KEY_SCHEME: []}, {}]
    return document


def _tell_defaults(schemas: dict[str, Any]) -> None:
    """Say in words what a field that is left out of a request is taken for.

    Generators take a field with a `default` for one that is always there, as it is in answers, and
    would have callers send all of them.
    """
    for name in _read(schemas, _MODELS["validation"]):
        for field in schemas[name].get("properties", {}).values():
            value = field.get("default")
            if "const" in field or "default" not in field:
                continue
            del field["default"]
            if isinstance(value, (str, float, bool)):
                shown = value if isinstance(value, str) else json.dumps(value)
                field["description"] = f"{field.get('description', '')} Default `{shown}`.".strip()


def _named_once(document: dict[str, Any]) -> dict[str, Any]:
    """Take out the lists of words that one place alone refers to, by their names."""
    references = Counter(_REFERENCE.findall(json.dumps(document)))
    schemas: dict[str, Any] = document["components"]["schemas"]
    names = [name for name in schemas if "enum" in schemas[name] and references[name] == 1]
    return {name: schemas.pop(name) for name in names}


def _plain(value: Any, words: Mapping[str, Any]) -> Any:
    """Write lists of words where they are used, and what all items of a tuple are.

    Generators make a type of each name, and few know `prefixItems`.
    """
    if isinstance(value, list):
        return [_plain(each, words) for each in cast("list[Any]", value)]
    if not isinstance(value, dict):
        return value
    plain = {name: _plain(each, words) for name, each in cast("dict[str, Any]", value).items()}
    name = str(plain.get("$ref", "")).rpartition("/")[2]
    if name in words:
        del plain["$ref"]
        return words[name] | plain
    choices = [kind for each in plain.get("oneOf", ()) for kind in _of_one_kind(each)]
    if len(choices) > len(plain.get("oneOf", ())):
        del plain["oneOf"]
        plain["anyOf"] = choices
    if "prefixItems" in plain:
        kinds = plain["prefixItems"]
        plain["items"] = kinds[0] if all(kind == kinds[0] for kind in kinds) else {}
    return plain


def _of_one_kind(schema: dict[str, Any]) -> list[dict[str, Any]]:
    """Tell an object whose values are of several kinds as a choice between objects of one kind.

    What generators make of a choice within a choice takes no JSON.
    """
    values = schema.get("additionalProperties")
    if not isinstance(values, dict) or "oneOf" not in values:
        return [schema]
    kinds = cast("list[dict[str, Any]]", values["oneOf"])
    return [schema | {"additionalProperties": kind} for kind in kinds]


def _drop_titles(schemas: Any) -> None:
    """Leave out pydantic's titles, which say a field's name again."""
    if isinstance(schemas, list):
        for each in cast("list[Any]", schemas):
            _drop_titles(each)
    if isinstance(schemas, dict):
        fields = cast("dict[str, Any]", schemas)
        for name, field in fields.items():
            if isinstance(field, dict) and field.get("title") == name.replace("_", " ").title():
                del field["title"]
            _drop_titles(field)


def _read(schemas: dict[str, Any], models: Iterable[type[BaseModel]]) -> set[str]:
    """The names of these types and of all that they are made of."""
    found: set[str] = set()
    waiting = [model.__name__ for model in models]
    while waiting:
        name = waiting.pop()
        if name not in found:
            found.add(name)
            waiting += _REFERENCE.findall(json.dumps(schemas[name]))
    return found


def _complete_operation(operation: dict[str, Any]) -> None:
    for parameter in operation.get("parameters", ()):
        _drop_null(parameter["schema"])
    for examples, content in _with_examples(operation):
        content["examples"] = {each: {"value": value} for each, value in examples.items()}
    for answer in operation["responses"].values():
        if "$ref" in answer:
            # FastAPI adds a description of its own.
            answer.pop("description", None)
    # What generators take for the answer's type and for what to ask for is the first of all.
    operation["responses"] = dict(sorted(operation["responses"].items()))


def _with_examples(operation: dict[str, Any]) -> Iterator[tuple[Examples, dict[str, Any]]]:
    """The operation's examples, each with the media type it is to stand at."""
    name: str = operation["operationId"]
    recorded = recorded_examples()
    if name in recorded["requests"]:
        bodies: dict[str, Any] = operation["requestBody"]["content"]
        examples = recorded["requests"][name]
        if JSON in bodies:
            yield examples, bodies[JSON]
        else:
            in_form = {each: {REQUEST: value} for each, value in examples.items()}
            yield in_form, bodies[MULTIPART]
    for status, examples in recorded["answers"].get(name, {}).items():
        content: dict[str, Any] = operation["responses"][status]["content"]
        yield examples, content[JSON] if JSON in content else next(iter(content.values()))


def _drop_null(schema: dict[str, Any]) -> None:
    """Say that a parameter may be left out, not that it may be null: there is no null in a URL."""
    kinds = [kind for kind in schema.get("anyOf", ()) if kind != {"type": "null"}]
    if len(kinds) == 1:
        del schema["anyOf"]
        schema |= kinds[0]
