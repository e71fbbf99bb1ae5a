"""What a new OpenAPI document takes away from the callers of an old one.

A request that was accepted must still be; an answer must still be what it was. So of requests the
new schema must allow all that the old one allowed; of answers (and of notices, which the service
sends) the old one must allow what the new one does, but for properties that are new. Additions
break nobody.
"""

from collections.abc import Iterator, Mapping
from types import MappingProxyType
from typing import Any, Final

from service.api.events import ITEMS
from tests.contract.document import Document, Operation, media_types, operations, whole

Schema = dict[str, Any]

LOWER_BOUNDS: Final = ("minimum", "exclusiveMinimum", "minLength", "minItems", "minProperties")
UPPER_BOUNDS: Final = ("maximum", "exclusiveMaximum", "maxLength", "maxItems", "maxProperties")
EXACT: Final = ("pattern", "format", "const", "contentEncoding", "contentMediaType")


def breaking_changes(
    old: Document, new: Document, *, renamed: Mapping[str, str] = MappingProxyType({})
) -> list[str]:
    """Describe every change that could break a caller.

    ``renamed`` has operations of the old document that have another name in the new one: they are
    still asked for as before, and only clients that are generated anew call them otherwise.
    """
    old, new = whole(old), whole(new)
    for operation in operations(old):
        operation.content["operationId"] = renamed.get(operation.id, operation.id)
    return [
        *_operations(old, new, "paths"),
        *_operations(old, new, "webhooks"),
    ]


def may_break(old: Document, new: Document) -> bool:
    """Say whether the version admits to breaking: another major one, or minor one below 1.0."""
    before, after = (tuple(map(int, each["info"]["version"].split("."))) for each in (old, new))
    significant = 2 if before[0] == 0 else 1
    return after[:significant] > before[:significant]


def _operations(old: Document, new: Document, section: str) -> Iterator[str]:
    found = {(each.path, each.method): each for each in operations(new, section)}
    for operation in operations(old, section):
        other = found.get((operation.path, operation.method))
        if other is None:
            yield f"{operation} is gone"
            continue
        if operation.id != other.id:
            yield f"{operation} is called {other.id}, not {operation.id}"
        yield from _parameters(operation, other, Comparison(old, new, is_read=False))
        yield from _answers(operation, other)
        if not _needs_body(operation) and _needs_body(other):
            yield f"{operation} needs a body"
        after = dict(media_types(other))
        for where, content in media_types(operation):
            # A notice is read by the caller and answered by it.
            is_read = where.startswith(f"{operation} request ") == (section == "webhooks")
            if where not in after:
                yield f"{where} is gone"
            else:
                comparison = Comparison(old, new, is_read=is_read)
                yield from comparison.changes(_schema(content), _schema(after[where]), where)


def _parameters(one: Operation, other: Operation, comparison: "Comparison") -> Iterator[str]:
    before, after = (
        {(each["in"], each["name"].lower()): each for each in operation.content["parameters"]}
        if "parameters" in operation.content
        else {}
        for operation in (one, other)
    )
    for key, parameter in before.items():
        where = f"{one} parameter {key[1]}"
        if key in after:
            yield from comparison.changes(parameter["schema"], after[key]["schema"], where)
        else:
            yield f"{where} is gone"
    for key, parameter in after.items():
        if parameter.get("required") and not before.get(key, {}).get("required"):
            yield f"{one} parameter {key[1]} is required"


def _answers(one: Operation, other: Operation) -> Iterator[str]:
    for status, answer in one.content["responses"].items():
        after = other.content["responses"].get(status)
        if after is None:
            yield f"{one} {status} is gone"
            continue
        for name in answer.get("headers", {}):
            if name not in after.get("headers", {}):
                yield f"{one} {status} header {name} is gone"


class Comparison:
    """Compares schemas of two documents, of what callers read or of what they write.

    One side says a thing and the other must understand it: callers of the old document write what
    the new one reads, and read what it writes.
    """

    def __init__(self, old: Document, new: Document, *, is_read: bool) -> None:
        self._old = old
        self._new = new
        self._is_read = is_read
        self._followed: set[tuple[str, str]] = set()

    def changes(self, old: Schema, new: Schema, where: str) -> Iterator[str]:
        """Describe what is no longer understood."""
        references = (old.get("$ref", ""), new.get("$ref", ""))
        if all(references):
            if references in self._followed:
                return
            self._followed.add(references)
        old, new = _resolved(old, self._old), _resolved(new, self._new)
        if _alternatives(old) or _alternatives(new):
            yield from self._alternatives(old, new, where)
            return
        said, understood = (new, old) if self._is_read else (old, new)
        yield from _values(said, understood, where)
        if self._is_read:
            for value in _listed(old) - _listed(new):
                yield f"{where}: {value} is gone"
        for name in set(understood.get("required", ())) - set(said.get("required", ())):
            yield f"{where}.{name} " + ("may be missing" if self._is_read else "is required")
        yield from self._parts(old, new, where)

    def _parts(self, old: Schema, new: Schema, where: str) -> Iterator[str]:
        properties = new.get("properties", {})
        for name, part in old.get("properties", {}).items():
            if name in properties:
                yield from self.changes(part, properties[name], f"{where}.{name}")
            elif self._is_read or new.get("additionalProperties") is False:
                yield f"{where}.{name} is gone"
        for name in ("items", "additionalProperties", "contentSchema"):
            parts = old.get(name), new.get(name)
            if all(isinstance(part, dict) for part in parts):
                yield from self.changes(*parts, f"{where}.{name}")
        before, after = old.get("prefixItems", []), new.get("prefixItems", [])
        if len(before) != len(after):
            yield f"{where} has {len(after)} items, not {len(before)}"
        for number, (one, other) in enumerate(zip(before, after, strict=False)):
            yield from self.changes(one, other, f"{where}.{number}")

    def _alternatives(self, old: Schema, new: Schema, where: str) -> Iterator[str]:
        """Describe the alternatives one side may say and the other understands none of."""
        before, after = (_alternatives(each) or [each] for each in (old, new))
        for said in after if self._is_read else before:
            pairs = (
                [(each, said) for each in before]
                if self._is_read
                else [(said, each) for each in after]
            )
            found = [self._fresh(*pair, where) for pair in pairs]
            if all(found):
                # Where there is but one to compare with, its faults say more.
                yield from found[0] if len(found) == 1 else [f"{where}: no more {_name(said)}"]

    def _fresh(self, old: Schema, new: Schema, where: str) -> list[str]:
        comparison = Comparison(self._old, self._new, is_read=self._is_read)
        comparison._followed = set(self._followed)
        return list(comparison.changes(old, new, where))


def _values(said: Schema, understood: Schema, where: str) -> Iterator[str]:
    """Describe by what the values of one schema exceed those of the other."""
    if understood.get("type") and not _types(said) <= _types(understood):
        yield f"{where}: {said.get('type', 'anything')} is not {understood['type']}"
    if _listed(understood):
        for value in _listed(said) - _listed(understood):
            yield f"{where}: {value} is not in both"
        if not _listed(said):
            yield f"{where}: the values are listed in one alone"
    for bounds, sign in ((LOWER_BOUNDS, 1), (UPPER_BOUNDS, -1)):
        for name in bounds:
            limit = understood.get(name)
            if limit is not None and (name not in said or sign * said[name] < sign * limit):
                yield f"{where}: {name} was {said.get(name)} or {limit}"
    for name in EXACT:
        if name in understood and said.get(name) != understood[name]:
            yield f"{where}: {name} differs"


def _types(schema: Schema) -> set[str]:
    kinds = schema.get("type", ["anything"])
    kinds = {kinds} if isinstance(kinds, str) else set(kinds)
    return kinds | {"integer"} if "number" in kinds else kinds


def _listed(schema: Schema) -> set[str]:
    return {repr(value) for value in schema.get("enum", ())}


def _alternatives(schema: Schema) -> list[Schema]:
    return schema.get("anyOf") or schema.get("oneOf") or []


def _schema(content: dict[str, Any]) -> Schema:
    # Of a stream the items are described.
    items = content.get(ITEMS)
    return content.get("schema", {}) if items is None else {"items": items}


def _needs_body(operation: Operation) -> bool:
    return operation.content.get("requestBody", {}).get("required", False)


def _name(schema: Schema) -> str:
    return schema.get("$ref", "").rpartition("/")[2] or str(schema.get("type", "such value"))


def _resolved(schema: Schema, document: Document) -> Schema:
    while "$ref" in schema:
        schema = document["components"]["schemas"][schema["$ref"].rpartition("/")[2]]
    return schema
