"""Stored result documents as they are told."""

import json

from api_schemas.fit import FitRequest
from api_schemas.results import ResultPart
from service.representation.results import result_json
from tests.integration.service.fake_results import fit_result
from tests.integration.service.harness import REQUEST

STORED = fit_result(FitRequest.model_validate_json(json.dumps(REQUEST)))


def told(document: dict[str, object], *parts: ResultPart) -> dict[str, object]:
    stored = json.dumps(document).encode()
    return json.loads(result_json(stored, included=frozenset(parts)))


def test_a_stored_document_is_told_whole_where_all_parts_are_asked_for():
    document = json.loads(STORED.model_dump_json())
    assert document["stages"] != []
    assert told(document, ResultPart.STAGES) == document
    assert told(document) == document | {"stages": []}
