"""The types of the HTTP API as tables of their fields."""

from collections.abc import Iterator, Mapping
from typing import Any

Document = Mapping[str, Any]
MOST_VALUES = 30
"""Longer lists of values are not written out in a table."""


def types_page(document: Document) -> Iterator[str]:
    yield from ("# Types", "", "What requests and answers are made of.", "")
    for name, schema in document["components"]["schemas"].items():
        yield from (f"(type-{name})=", f"## {name}", "")
        if schema.get("description"):
            yield from (schema["description"], "")
        if "enum" in schema:
            yield from (" ".join(f"`{value}`" for value in schema["enum"]), "")
        yield from fields_table(document, schema)


def fields_table(document: Document, schema: Document) -> Iterator[str]:
    """The fields of an object, or a line that says what else it is."""
    resolved = referred(document, schema)
    if "properties" not in resolved:
        if "enum" not in resolved:
            yield from (kind_of(schema, link=True), "")
        return
    required = set(resolved.get("required", ()))
    yield from ("| field | type | meaning |", "|---|---|---|")
    for name, field in resolved["properties"].items():
        named = f"`{name}`" if name in required else f"`{name}` (optional)"
        yield f"| {named} | {kind_of(field, link=True)} | {meaning(field)} |"
    yield ""


def referred(document: Document, schema: Document) -> Document:
    reference = schema.get("$ref")
    return document["components"]["schemas"][reference.rpartition("/")[2]] if reference else schema


def meaning(field: Document) -> str:
    said = " ".join(field.get("description", "").split()).replace("|", "\\|")
    default = field.get("default")
    if default is not None and default != "":
        said = f"{said} Default `{default}`.".strip()
    return said


def kind_of(schema: Document, *, link: bool) -> str:
    """What a value is: "number from 1.2 to 2.3", "list of Point", "null"."""
    if "$ref" in schema:
        name = schema["$ref"].rpartition("/")[2]
        return f"[{name}](#type-{name})" if link else name
    choices = schema.get("anyOf") or schema.get("oneOf") or schema.get("allOf")
    if choices:
        kinds = dict.fromkeys(kind_of(each, link=link) for each in choices)
        return " or ".join(kind for kind in kinds if kind != "null") or "null"
    if "const" in schema:
        return f"`{schema['const']}`"
    if "enum" in schema:
        values = [f"`{value}`" for value in schema["enum"]]
        return " or ".join(values) if len(values) <= MOST_VALUES else "one of a list of names"
    kind = schema.get("type", "anything")
    if kind == "array":
        items = schema.get("prefixItems")
        if items:
            return "[" + ", ".join(kind_of(each, link=link) for each in items) + "]"
        return f"list of {kind_of(schema.get('items', {}), link=link)}"
    if kind == "object" and isinstance(schema.get("additionalProperties"), Mapping):
        return f"object of {kind_of(schema['additionalProperties'], link=link)} by name"
    return " ".join(filter(None, (str(schema.get("format") or kind), limits(schema))))


def limits(schema: Document) -> str:
    low, high = schema.get("minimum"), schema.get("maximum")
    above, below = schema.get("exclusiveMinimum"), schema.get("exclusiveMaximum")
    parts = [
        f"from {low}" if low is not None else f"above {above}" if above is not None else "",
        f"to {high}" if high is not None else f"below {below}" if below is not None else "",
    ]
    longest = schema.get("maxLength")
    if longest is not None:
        parts.append(f"of at most {longest} characters")
    return " ".join(filter(None, parts))
