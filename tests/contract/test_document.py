"""The OpenAPI document says everything, and what it says by example is true."""

import copy
import json
from collections.abc import Iterator
from typing import Any

import jsonschema_rs
import pytest

from api_schemas.jobs import EventData
from service.api.events import ITEMS
from tests.contract.document import exported, media_types, operations, validator, whole

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
    item = validator(content["text/event-stream"][ITEMS], DOCUMENT)
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
