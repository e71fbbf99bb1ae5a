"""The OpenAPI document says everything, and what it says by example is true."""

import copy
import json
from collections.abc import Iterator
from contextlib import nullcontext
from typing import Any

import jsonschema_rs
import pytest
from pydantic import BaseModel, ValidationError

from api_schemas.jobs import EventData
from api_schemas.picture import ViewRequest
from api_schemas.questions import InitialPoseRequest, PointsRequest
from service.api.app import openapi_text
from tests.contract.document import EXPORTED, exported, media_types, operations, validator, whole

DOCUMENT = whole(exported())
OPERATIONS = list(operations(DOCUMENT))
BODIES = [
    (where, content)
    for section in ("paths", "webhooks")
    for operation in operations(DOCUMENT, section)
    for where, content in media_types(operation)
]
EXAMPLES = [
    pytest.param(content["schema"], example["value"], id=f"{where} {name}")
    for where, content in BODIES
    if "schema" in content
    for name, example in content.get("examples", {}).items()
]
BINARY = {"type": "string", "format": "binary"}
ANY_FILE = {"type": "object"}
"""A file that is JSON."""


@pytest.mark.parametrize(("schema", "value"), EXAMPLES)
def test_every_example_is_of_its_schema(schema, value):
    errors = [error.message for error in validator(schema, DOCUMENT).iter_errors(value)]
    assert errors == []


def test_every_example_in_a_type_is_of_that_type():
    def examples(schema, where):
        if isinstance(schema, dict):
            for value in schema.get("examples", ()) if "type" in schema else ():
                yield where, schema, value
            for name, part in schema.items():
                yield from examples(part, f"{where}.{name}")

    found = list(examples(DOCUMENT["components"]["schemas"], "schemas"))
    assert found
    wrong = [
        (where, value)
        for where, schema, value in found
        if not validator(schema, DOCUMENT).is_valid(value)
    ]
    assert wrong == []


def test_a_wrong_example_would_be_noticed():
    schema, value = next(each.values for each in EXAMPLES if " request " in each.id)
    broken = copy.deepcopy(value)
    broken["request"]["views"][0]["points"]["left_shoulder"] = [1, 2, 3, 4, 5]
    with pytest.raises(jsonschema_rs.ValidationError):
        validator(schema, DOCUMENT).validate(broken)


NAMED = {
    "left_shoulder": (438, 220),
    "right_shoulder": (251, 225),
    "left_hip": (390, 466),
    "right_hip": (301, 462),
    "left_knee": (408, 675),
}
POSE = {"gender": "male", "height_m": 1.8, "image_size": {"width": 720, "height": 960}}
POINTS_OF: dict[type[BaseModel], dict[str, object]] = {
    ViewRequest: {},
    PointsRequest: {},
    InitialPoseRequest: POSE,
}
"""Types of requests with points, and what else they need."""


@pytest.mark.parametrize("kind", POINTS_OF, ids=lambda kind: kind.__name__)
@pytest.mark.parametrize(
    ("points", "is_right"),
    [
        ({name: [x, y] for name, (x, y) in NAMED.items()}, True),
        ({name: [x, y, 1] for name, (x, y) in NAMED.items()}, True),
        ({name: {"x": x, "y": y} for name, (x, y) in NAMED.items()}, True),
        (
            {
                name: {"x": x, "y": y, "source": "proposal", "confidence": 0.9, "visibility": 1}
                for name, (x, y) in NAMED.items()
            },
            True,
        ),
        ([[20.0 * row, 30.0 * row, 2] for row in range(17)], True),
        ([[20.0 * row, 30.0 * row, 0.9] for row in range(17)], True),
        ([[20.0 * row, 30.0 * row, 2] for row in range(16)], False),
        ([[20.0 * row, 30.0 * row] for row in range(17)], False),
        ({"left_shoulder": [438]}, False),
        ({"left_shoulder": [438, 220, 2, 1]}, False),
        ({"left_shoulder": {"x": 438}}, False),
        ({"left_shoulder": {"x": 438, "y": 220, "z": 1}}, False),
        ({"left_shoulder": ["438", "220"]}, False),
        ({"shoulder": [438, 220]}, False),
        ("automatic", False),
        (5, False),
    ],
)
def test_points_are_taken_in_the_forms_that_the_document_names(
    kind: type[BaseModel], points: object, *, is_right: bool
):
    request = POINTS_OF[kind] | {"points": points}
    schema = {"$ref": f"#/components/schemas/{kind.__name__}"}
    assert validator(schema, DOCUMENT).is_valid(request) is is_right
    with nullcontext() if is_right else pytest.raises(ValidationError):
        kind.model_validate_json(json.dumps(request))


def test_every_body_has_an_example_but_those_that_are_no_text():
    """A picture or a GLB file cannot be shown in a JSON document; a form holds one."""
    silent = {
        where
        for where, content in BODIES
        if not content.get("examples")
        and content.get("schema") not in (BINARY, ANY_FILE)
        and not where.endswith(("multipart/form-data", "application/problem+json"))
    }
    assert silent == set()


def test_the_example_of_the_event_stream_is_a_stream_of_events():
    content = DOCUMENT["paths"]["/v1/fits/{fit_id}/events"]["get"]["responses"]["200"]["content"]
    item = validator(content["text/event-stream"]["schema"]["contentSchema"]["items"], DOCUMENT)
    (example,) = content["text/event-stream"]["examples"].values()
    _, *events = example["value"].rstrip("\n").split("\n\n")
    for event in events:
        fields = dict(line.split(": ", 1) for line in event.splitlines())
        item.validate(fields)
        EventData.model_validate_json(fields["data"])
    assert events[-1].startswith("event: end")


@pytest.mark.parametrize("operation", OPERATIONS, ids=str)
def test_every_operation_says_how_it_ends(operation):
    statuses = {int(status) for status in operation.content["responses"]}
    assert any(status < 300 for status in statuses)
    assert {401, 403, 405, 408, 429, 503} <= statuses
    if "requestBody" in operation.content:
        assert {400, 413, 415, 422} <= statuses
    if "{" in operation.path:
        assert 404 in statuses
    if any(parameter["in"] != "header" for parameter in operation.content.get("parameters", ())):
        assert {404, 422} & statuses
    assert all(answer["description"] for answer in operation.content["responses"].values())
    assert operation.content["summary"]
    assert operation.content["description"]


def test_the_exported_document_is_up_to_date():
    assert EXPORTED.read_text() == openapi_text(), "run `make openapi`"


def test_every_error_of_every_operation_is_a_problem():
    for operation in OPERATIONS:
        for status, answer in operation.content["responses"].items():
            if int(status) >= 400:
                assert list(answer["content"]) == ["application/problem+json"], operation


def test_parameters_are_left_out_and_never_null():
    text = json.dumps([operation.content.get("parameters", []) for operation in OPERATIONS])
    assert '"null"' not in text


def test_generators_find_the_answer_first_and_one_way_to_send_pictures():
    """They ask for the first type of all answers, and prefer JSON to a form that holds files."""
    for path, offered in DOCUMENT["paths"].items():
        for operation in offered.values():
            assert next(iter(operation["responses"])).startswith("2"), path
            sent = operation.get("requestBody", {"content": {}})["content"]
            assert len(sent) <= 1 or path.endswith("/products"), path


def test_every_tuple_says_what_its_items_are():
    def tuples(value: Any) -> Iterator[dict[str, Any]]:
        if isinstance(value, dict):
            yield from [value] if "prefixItems" in value else []
            value = list(value.values())
        for each in value if isinstance(value, list) else ():
            yield from tuples(each)

    assert all("items" in each for each in tuples(DOCUMENT))
