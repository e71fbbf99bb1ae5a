"""How large the product may be: one table of ceilings, which a commit may lower and never raise.

What adds an operation, a setting, a field or a kind takes one away.
`python -m tests.unit.test_budget` prints what stands today.
"""

import json
import tomllib
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any, Final

from service.settings import Settings

ROOT: Final = Path(__file__).parents[2]

CEILINGS: Final = {
    "service and api_schemas: lines of Python": 18_073,
    "fitter without training: lines of Python": 36_808,
    "fitter/training: lines of Python": 9_890,
    "product modules": 440,
    "operations": 30,
    "schemas": 85,
    "request fields": 90,
    "settings": 32,
    "OpenAPI, compact: bytes": 170_000,
    "page: lines of TypeScript and CSS": 15_000,
    "documentation: words": 32_889,
    "run-time dependencies": 24,
    "tests: lines of Python": 53_685,
    "tests: modules": 397,
}

METHODS: Final = ("get", "post", "put", "patch", "delete", "head")


def lines(files: Iterable[Path]) -> int:
    return sum(len(path.read_text().splitlines()) for path in files)


def modules(*parts: str) -> list[Path]:
    return sorted(ROOT.joinpath(*parts).rglob("*.py"))


def references(schema: object) -> Iterator[str]:
    """Where a schema points to, but for its examples."""
    if isinstance(schema, dict):
        for key, value in schema.items():
            if key == "$ref":
                yield value
            elif key not in ("example", "examples"):
                yield from references(value)
    elif isinstance(schema, list):
        for each in schema:
            yield from references(each)


def request_fields(document: dict[str, Any]) -> int:
    """Fields of all schemas that bodies of requests reach, each schema counted once."""
    bodies = [
        content["schema"]
        for path in document["paths"].values()
        for operation in path.values()
        if isinstance(operation, dict) and "requestBody" in operation
        for content in operation["requestBody"]["content"].values()
    ]
    waiting = list(references(bodies))
    reached: set[str] = set()
    fields = 0
    while waiting:
        name = waiting.pop().rpartition("/")[2]
        schema = document["components"]["schemas"].get(name)
        if schema is None or name in reached:
            continue
        reached.add(name)
        fields += len(schema.get("properties", {}))
        waiting.extend(references(schema))
    return fields


def words() -> int:
    pages = [*ROOT.glob("*.md"), *(ROOT / "service" / "docs").rglob("*.md")]
    return sum(len(page.read_text().split()) for page in pages)


def page_sources() -> list[Path]:
    page = ROOT / "service" / "page"
    return [
        path
        for path in (*page.glob("*"), *(page / "src").rglob("*"))
        if path.suffix in (".ts", ".tsx", ".css")
    ]


def measured() -> dict[str, int]:
    text = (ROOT / "api_schemas" / "openapi.json").read_text()
    document = json.loads(text)
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    serving = modules("service") + modules("api_schemas")
    fitting = modules("fitter")
    training = modules("fitter", "training")
    tests = modules("tests")
    return {
        "service and api_schemas: lines of Python": lines(serving),
        "fitter without training: lines of Python": lines(fitting) - lines(training),
        "fitter/training: lines of Python": lines(training),
        "product modules": len(serving) + len(fitting),
        "operations": sum(
            method in METHODS for path in document["paths"].values() for method in path
        ),
        "schemas": len(document["components"]["schemas"]),
        "request fields": request_fields(document),
        "settings": len(Settings.model_fields),
        "OpenAPI, compact: bytes": len(
            json.dumps(document, separators=(",", ":"), ensure_ascii=False).encode()
        ),
        "page: lines of TypeScript and CSS": lines(page_sources()),
        "documentation: words": words(),
        "run-time dependencies": len(project["dependencies"]),
        "tests: lines of Python": lines(tests),
        "tests: modules": len(tests),
    }


def table(today: dict[str, int]) -> str:
    rows = [f"{'':44}{'today':>9}{'ceiling':>9}"]
    rows += [f"{name:44}{today[name]:9,}{ceiling:9,}" for name, ceiling in CEILINGS.items()]
    return "\n".join(rows)


def test_no_figure_is_above_its_ceiling():
    today = measured()
    assert all(today[name] <= ceiling for name, ceiling in CEILINGS.items()), "\n" + table(today)


def test_every_figure_has_a_ceiling():
    assert set(measured()) == set(CEILINGS)


if __name__ == "__main__":
    print(table(measured()))
