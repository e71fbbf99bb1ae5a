"""The exported OpenAPI document, and ways through it."""

import json
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import jsonschema_rs

import api_schemas

FOLDER = Path(api_schemas.__file__).parent
EXPORTED = FOLDER / "openapi.json"
METHODS = ("get", "put", "post", "delete", "options", "head", "patch", "trace")

Document = dict[str, Any]


def exported() -> Document:
    return json.loads(EXPORTED.read_text())


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
