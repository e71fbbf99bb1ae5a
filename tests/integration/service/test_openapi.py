"""The contract: the exported document is the served one, and speaks of everything."""

import json

from service.api.app import openapi_text
from tests.contract.document import EXPORTED, exported, operations, whole
from tests.integration.service.harness import Service

MOST_BYTES = 350_000
"""Of the document without spaces; with every error written out it were twice as many."""


def test_the_exported_document_is_up_to_date():
    assert EXPORTED.read_text() == openapi_text(), "run `make openapi`"


def test_the_served_document_is_the_exported_one(service: Service):
    assert service.client.get("/openapi.json").json() == json.loads(EXPORTED.read_text())


def test_the_documentation_page_is_served(service: Service):
    assert service.client.get("/docs").status_code == 200


def test_every_reference_in_the_document_leads_somewhere():
    text = EXPORTED.read_text()
    components = json.loads(text)["components"]
    references = {part.partition('"')[0] for part in text.split('"#/components/')[1:]}
    there_are = {f"{section}/{name}" for section, names in components.items() for name in names}
    assert references <= there_are


def test_every_error_of_every_operation_is_a_problem():
    for operation in operations(whole(exported())):
        for status, answer in operation.content["responses"].items():
            if int(status) >= 400:
                assert list(answer["content"]) == ["application/problem+json"], operation


def test_what_is_the_same_everywhere_is_said_once():
    compact = json.dumps(exported(), separators=(",", ":"), ensure_ascii=False)
    assert len(compact.encode()) <= MOST_BYTES
