"""The contract: the exported document is the served one, and speaks of everything."""

import json
from pathlib import Path

import api_schemas
from service.api.app import openapi_text
from tests.integration.service.harness import Service

EXPORTED = Path(api_schemas.__file__).parent / "openapi.json"


def test_the_exported_document_is_up_to_date():
    assert EXPORTED.read_text() == openapi_text(), "run `maquette openapi --output` anew"


def test_the_served_document_is_the_exported_one(service: Service):
    assert service.client.get("/openapi.json").json() == json.loads(EXPORTED.read_text())


def test_the_documentation_page_is_served(service: Service):
    assert service.client.get("/docs").status_code == 200


def test_every_reference_in_the_document_leads_somewhere():
    text = EXPORTED.read_text()
    schemas = json.loads(text)["components"]["schemas"]
    references = {part.partition('"')[0] for part in text.split('"#/components/schemas/')[1:]}
    assert references <= set(schemas)


def test_every_error_of_every_operation_is_a_problem():
    for path, operations in json.loads(EXPORTED.read_text())["paths"].items():
        for operation in operations.values():
            for status, answer in operation["responses"].items():
                if int(status) >= 400:
                    assert list(answer["content"]) == ["application/problem+json"], path
