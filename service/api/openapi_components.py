"""Move what the OpenAPI document would repeat into its components.

Written out everywhere, errors alone were two fifths of the document.
"""

import json
from collections import defaultdict
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Any

from service.api.problems import RESPONSES, shared_response

Document = dict[str, Any]


@dataclass(frozen=True, slots=True)
class _Place:
    """Where the document says something: ``holder[key]``, and what to call it if it is shared."""

    holder: Any
    key: str | int
    names: tuple[str, ...]

    @property
    def value(self) -> Any:
        return self.holder[self.key]


def share_components(document: Document) -> None:
    """Describe the problems that operations refer to, and share what they have in common."""
    components = document["components"]
    referred = {
        answer["$ref"].removeprefix(RESPONSES)
        for operation in _operations(document)
        for answer in operation["responses"].values()
        if "$ref" in answer
    }
    components["responses"] = {name: shared_response(name) for name in sorted(referred)}
    components["examples"] = _shared("examples", _examples(document))
    components["parameters"] = _shared("parameters", _parameters(document))
    components["responses"] |= _shared("responses", _answers(document))


def _shared(section: str, places: Iterable[_Place]) -> dict[str, Any]:
    """Replace what several places say by references; returns what these refer to, by name."""
    alike: defaultdict[str, list[_Place]] = defaultdict(list)
    for place in places:
        alike[json.dumps(place.value, sort_keys=True)].append(place)
    shared: dict[str, Any] = {}
    for same in alike.values():
        if len(same) > 1:
            name = next(each for each in same[0].names if each not in shared)
            shared[name] = same[0].value
            for place in same:
                place.holder[place.key] = {"$ref": f"#/components/{section}/{name}"}
    return dict(sorted(shared.items()))


def _examples(document: Document) -> Iterator[_Place]:
    for answer in document["components"]["responses"].values():
        yield from _examples_in(answer, "problem")
    for operation in _operations(document):
        for said in (operation.get("requestBody", {}), *operation["responses"].values()):
            yield from _examples_in(said, operation["operationId"])


def _examples_in(said: Document, where: str) -> Iterator[_Place]:
    for content in said.get("content", {}).values():
        examples = content.get("examples", {})
        for name in examples:
            yield _Place(examples, name, (f"{where}.{name}",))


def _parameters(document: Document) -> Iterator[_Place]:
    for operation in _operations(document):
        parameters = operation.get("parameters", [])
        for number, each in enumerate(parameters):
            name = each["name"]
            yield _Place(parameters, number, (name, f"{operation['operationId']}.{name}"))


def _answers(document: Document) -> Iterator[_Place]:
    for operation in _operations(document):
        answers = operation["responses"]
        for status, each in answers.items():
            if "content" in each:
                yield _Place(answers, status, (f"{operation['operationId']}.{status}",))


def _operations(document: Document) -> Iterator[Document]:
    for section in ("paths", "webhooks"):
        for item in document[section].values():
            yield from item.values()
