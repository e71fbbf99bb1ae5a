"""The table of a fit's fields in the guide, as the contract has them.

``python -m tests.contract.request_table`` writes it.
"""

from collections.abc import Iterator, Mapping
from enum import Enum
from typing import Any, Final

from pydantic import BaseModel

from api_schemas.fit import FitRequest
from api_schemas.picture import ViewRequest
from tests.contract.document import REPOSITORY, exported

PAGE: Final = REPOSITORY / "service" / "docs" / "guide" / "requests.md"
BEGIN, END = "<!-- fields -->\n", "<!-- until here -->\n"
TYPES: Final = ((FitRequest, ""), (ViewRequest, "views.0."))
"""What is said of the person and of the fit, and of a picture."""

MOST_VALUES: Final = 6

Schema = Mapping[str, Any]


def request_table() -> str:
    """Rows of Markdown: name, type, default and meaning of each field."""
    schemas = exported()["components"]["schemas"]
    rows = [
        f"| {' | '.join(_cells(kind, name, schemas, at=prefix))} |"
        for kind, prefix in TYPES
        for name in kind.model_fields
    ]
    return "\n".join(("| field | type | default | meaning |", "|---|---|---|---|", *rows, ""))


def _cells(kind: type[BaseModel], name: str, schemas: Schema, *, at: str) -> Iterator[str]:
    field = schemas[kind.__name__]["properties"][name]
    yield f"`{at}{name}`"
    yield " or ".join(dict.fromkeys(_kinds(field, schemas)))
    yield _default(kind, name)
    said = " ".join(_descriptions(field)).partition(" Default `")[0]
    yield " ".join(said.split()).replace("|", "\\|")


def _default(kind: type[BaseModel], name: str) -> str:
    field = kind.model_fields[name]
    if field.is_required():
        return "needed"
    value = field.get_default(call_default_factory=True)
    if value is None or isinstance(value, BaseModel | dict | tuple):
        return ""
    shown = value.value if isinstance(value, Enum) else str(value).lower()
    return f"`{shown}`"


def _kinds(schema: Schema, schemas: Schema) -> Iterator[str]:
    choices = schema.get("anyOf") or schema.get("oneOf") or ()
    for each in choices:
        yield from _kinds(each, schemas)
    if "$ref" in schema:
        name = schema["$ref"].rpartition("/")[2]
        named = schemas[name]
        yield from [f"`{name}`"] if "properties" in named else _kinds(named, schemas)
    elif "enum" in schema:
        values = [f"`{value}`" for value in schema["enum"]]
        yield from values if len(values) <= MOST_VALUES else ["a name"]
    elif "const" in schema:
        yield f"`{schema['const']}`"
    elif isinstance(schema.get("additionalProperties"), Mapping):
        of = " or ".join(dict.fromkeys(_kinds(schema["additionalProperties"], schemas)))
        yield f"{of} by name"
    elif not choices and schema.get("type") != "null":
        low, high = schema.get("minimum"), schema.get("maximum")
        within = "" if low is None or high is None else f" from {low:g} to {high:g}"
        kind = {"boolean": "true or false", "array": "list", "string": "text"}
        yield kind.get(schema["type"], schema["type"]) + within


def _descriptions(schema: Schema) -> Iterator[str]:
    if "description" in schema:
        yield schema["description"]
        return
    for each in schema.get("anyOf", ()):
        yield from _descriptions(each)


def parts(text: str) -> tuple[str, str, str]:
    """What stands before the table, the table, and what stands behind it."""
    before, _, rest = text.partition(BEGIN)
    table, _, after = rest.partition(END)
    return before, table, after


if __name__ == "__main__":
    before, _, after = parts(PAGE.read_text())
    PAGE.write_text(before + BEGIN + request_table() + END + after)
