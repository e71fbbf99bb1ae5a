"""Pages of the HTTP API from its OpenAPI document: one a tag, one of types, one of failures."""

import json
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from _extensions.http_types import fields_table, kind_of, types_page
from sphinx.application import Sphinx

Document = Mapping[str, Any]
METHODS = ("get", "post", "delete")
SUCCESS = range(200, 400)
SHARED = ("responses", "examples", "parameters")


def setup(app: Sphinx) -> dict[str, bool]:
    app.connect("builder-inited", write_pages)
    return {"parallel_read_safe": True, "parallel_write_safe": True}


def write_pages(app: Sphinx) -> None:
    document = whole(
        json.loads((Path(app.srcdir).parents[1] / "api_schemas" / "openapi.json").read_text())
    )
    folder = Path(app.srcdir) / "reference" / "http"
    folder.mkdir(exist_ok=True)
    pages = {page_name(tag["name"]): tag_page(document, tag) for tag in document["tags"]}
    pages |= {"types": types_page(document), "failures": failures_page(document)}
    for name, lines in pages.items():
        write_if_new(folder / f"{name}.md", "\n".join(lines) + "\n")


def whole(document: Document) -> dict[str, Any]:
    """The document with what operations share written out, but for types."""

    def resolved(said: Any) -> Any:
        if isinstance(said, list):
            return [resolved(each) for each in said]
        if not isinstance(said, dict):
            return said
        section, _, name = said.get("$ref", "").removeprefix("#/components/").partition("/")
        if section in SHARED:
            return resolved(document["components"][section][name])
        return {key: resolved(value) for key, value in said.items()}

    return {**document, "paths": resolved(document["paths"])}


def write_if_new(path: Path, text: str) -> None:
    """An unchanged page keeps its time, and is not read again."""
    if not path.exists() or path.read_text() != text:
        path.write_text(text)


def page_name(tag: str) -> str:
    return tag.replace(" ", "-")


def tag_page(document: Document, tag: Document) -> Iterator[str]:
    yield from (f"# {tag['name'].capitalize()}", "", tag["description"], "")
    for path, operations in document["paths"].items():
        for method in METHODS:
            operation = operations.get(method)
            if operation and tag["name"] in operation["tags"]:
                yield from operation_section(document, f"{method.upper()} {path}", operation)


def operation_section(document: Document, line: str, operation: Document) -> Iterator[str]:
    yield from (f"({operation['operationId']})=", f"## {operation['summary']}", "")
    yield from ("```text", line, "```", "", operation.get("description", ""), "")
    parameters = operation.get("parameters", [])
    if parameters:
        yield from ("| parameter | in | type | meaning |", "|---|---|---|---|")
        for each in parameters:
            meaning = one_line(each.get("description", ""))
            kind = kind_of(each["schema"], link=True)
            yield f"| `{each['name']}` | {each['in']} | {kind} | {meaning} |"
        yield ""
    for media_type, content in operation.get("requestBody", {}).get("content", {}).items():
        yield from (f"Request as `{media_type}`:", "")
        yield from fields_table(document, content["schema"])
        yield from samples(content)
    answers = sorted(operation["responses"].items(), key=lambda item: int(item[0]))
    for status, answer in answers:
        if int(status) in SUCCESS:
            yield from success(status, answer)
    yield from ("| failure | codes |", "|---|---|")
    for status, answer in answers:
        if int(status) not in SUCCESS:
            codes = " ".join(f"[`{code}`](#problem-{code})" for code in problem_codes(answer))
            yield f"| {status} {answer['description']} | {codes} |"
    yield ""


def success(status: str, answer: Document) -> Iterator[str]:
    yield from (f"**{status}**: {answer['description']}", "")
    for media_type, content in answer.get("content", {}).items():
        schema = content.get("schema") or content.get("itemSchema") or {}
        yield from (f"`{media_type}`: {kind_of(schema, link=True)}", "")
        yield from samples(content)


def samples(content: Document) -> Iterator[str]:
    for name, example in content.get("examples", {}).items():
        value = example["value"]
        is_text = isinstance(value, str)
        yield from (f":::{{dropdown}} Sample: {name.replace('-', ' ')}", "")
        yield from ("```" + ("text" if is_text else "json"),)
        yield value if is_text else json.dumps(value, indent=2, ensure_ascii=False)
        yield from ("```", ":::", "")


def problem_codes(answer: Document) -> list[str]:
    contents = answer.get("content", {}).values()
    return [code for content in contents for code in content.get("examples", {})]


def failures_page(document: Document) -> Iterator[str]:
    """Every type of problem with a sample, as the operations show it."""
    yield from ("# Failures", "")
    yield "Every error is `application/problem+json` (RFC 9457) on every path. `code` is stable,"
    yield from ("`errors` name the fields at fault, and `remedy` says what to do.", "")
    found: dict[str, tuple[str, Any]] = {}
    for operations in document["paths"].values():
        for operation in operations.values():
            for status, answer in operation["responses"].items():
                for content in answer.get("content", {}).values():
                    if int(status) not in SUCCESS:
                        for code, example in content.get("examples", {}).items():
                            found.setdefault(code, (status, example["value"]))
    for code, (status, value) in sorted(found.items(), key=lambda item: (item[1][0], item[0])):
        yield from (f"(problem-{code})=", f"## {status} `{code}`", "")
        yield from (f"{value['title']}. {value['detail']}", "")
        yield from ("```json", json.dumps(value, indent=2, ensure_ascii=False), "```", "")


def one_line(text: str) -> str:
    return " ".join(text.split()).replace("|", "\\|")
