"""The exported OpenAPI document, and ways through it.

``python -m tests.contract.document`` exports it.
"""

import json
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import jsonschema_rs

import api_schemas

FOLDER = Path(api_schemas.__file__).parent
REPOSITORY = FOLDER.parent
EXPORTED = FOLDER / "openapi.json"
METHODS = ("get", "put", "post", "delete", "options", "head", "patch", "trace")

SECTIONS = ("paths", "webhooks")
SHARED = ("responses", "examples", "parameters")
"""What operations share by reference, besides types."""

Document = dict[str, Any]


def exported() -> Document:
    return json.loads(EXPORTED.read_text())


def whole(document: Document) -> Document:
    """The document with responses, examples and parameters where they are referred to.

    What stands behind a reference is the same as what is written out; types keep theirs.
    """
    shared = document.get("components", {})

    def resolved(said: Any) -> Any:
        if isinstance(said, list):
            return [resolved(each) for each in said]
        if not isinstance(said, dict):
            return said
        section, _, name = said.get("$ref", "").removeprefix("#/components/").partition("/")
        if section in SHARED:
            return resolved(shared[section][name])
        return {key: resolved(value) for key, value in said.items()}

    return document | {name: resolved(document[name]) for name in SECTIONS if name in document}


@dataclass(frozen=True)
class Operation:
    path: str
    method: str
    content: dict[str, Any]

    @property
    def id(self) -> str:
        return self.content["operationId"]

    def __str__(self) -> str:
        return f"{self.method.upper()} {self.path}"


def operations(document: Document, section: str = "paths") -> Iterator[Operation]:
    for path, methods in document.get(section, {}).items():
        for method in METHODS:
            if method in methods:
                yield Operation(path, method, methods[method])


def media_types(operation: Operation) -> Iterator[tuple[str, dict[str, Any]]]:
    """Every body of an operation: where it stands and what it says."""
    for kind, content in operation.content.get("requestBody", {}).get("content", {}).items():
        yield f"{operation} request {kind}", content
    for status, answer in operation.content["responses"].items():
        for kind, content in answer.get("content", {}).items():
            yield f"{operation} {status} {kind}", content


def validator(schema: dict[str, Any], document: Document) -> jsonschema_rs.Draft202012Validator:
    """Validate against a schema of the document, formats and references included."""
    whole = {**schema, "components": document["components"]}
    return jsonschema_rs.Draft202012Validator(whole, validate_formats=True)


if __name__ == "__main__":
    # Imported here: whoever reads the document needs no service.
    from service.api.app import openapi_text

    EXPORTED.write_text(openapi_text())
