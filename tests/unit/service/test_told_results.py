"""Stored result documents, of this version and of others, as they are told."""

import json

from api_schemas.requests import FitOptions
from api_schemas.results import FitResult, ResultPart
from service.representation.results import result_json
from tests.integration.service.fake_results import fit_result
from tests.integration.service.harness import REQUEST

STORED = fit_result(FitOptions.model_validate_json(json.dumps(REQUEST)))


def told(document: dict[str, object], *parts: ResultPart) -> dict[str, object]:
    stored = json.dumps(document).encode()
    return json.loads(result_json(stored, kind=FitResult, included=frozenset(parts)))


def test_a_stored_document_is_told_whole_where_all_parts_are_asked_for():
    document = json.loads(STORED.model_dump_json())
    assert document["stages"] != []
    assert told(document, ResultPart.STAGES) == document
    assert told(document) == document | {"stages": []}


def test_a_document_of_version_1_0_is_told_with_intervals_and_without_stages():
    document = json.loads(STORED.model_dump_json())
    for measurement in document["measurements"]:
        del measurement["low"], measurement["high"]
    waist = told(document)["measurements"][0]
    assert (waist["low"], waist["high"]) == (
        round(waist["value"] - 1.96, 2),
        round(waist["value"] + 1.96, 2),
    )


def test_where_no_error_is_known_there_is_no_interval():
    document = json.loads(STORED.model_dump_json())
    document["measurements"] = [
        document["measurements"][0] | {"standard_error": None, "low": None, "high": None}
    ]
    assert told(document)["measurements"] == document["measurements"]
    del document["measurements"][0]["low"]
    assert told(document)["measurements"][0]["low"] is None


def test_what_a_later_version_added_is_passed_over():
    document = json.loads(STORED.model_dump_json())
    assert told(document | {"of_tomorrow": 1}) == told(document)
