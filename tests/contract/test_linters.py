"""Two independent linters have nothing to complain of in the document, and are awake."""

import json
import os
import subprocess
from collections.abc import Iterable
from pathlib import Path

import pytest

from tests.contract.document import EXPORTED, Document, exported
from tests.external_tools import installed

pytestmark = pytest.mark.slow  # npm installs them

FOLDER = Path(__file__).parents[1] / "openapi_linters"
FOUND_SOMETHING = 1


@pytest.fixture(scope="module")
def tools() -> Path:
    return installed(FOLDER) / "node_modules" / ".bin"


def run(*command: str | Path, **variables: str) -> str:
    """Run a linter, which is ended if it asks the network; returns what it writes as JSON."""
    offline = {"NODE_OPTIONS": f"--require {FOLDER / 'offline.cjs'}"}
    done = subprocess.run(
        [str(part) for part in command],
        cwd=FOLDER,
        env=os.environ | offline | variables,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode in {0, FOUND_SOMETHING}, done.stdout + done.stderr
    return done.stdout


def by_rule(problems: Iterable[tuple[str, str]]) -> dict[str, list[str]]:
    rules: dict[str, list[str]] = {}
    for rule, message in problems:
        rules.setdefault(rule, []).append(message)
    return rules


def redocly(tools: Path, document: Path) -> dict[str, list[str]]:
    """What Redocly says by rule, warnings included."""
    found = json.loads(
        run(
            *(tools / "redocly", "lint", document, "--config", "redocly.yaml"),
            *("--format", "json"),
            REDOCLY_TELEMETRY="off",
            REDOCLY_SUPPRESS_UPDATE_NOTICE="true",
        )
    )
    return by_rule((each["ruleId"], each["message"]) for each in found["problems"])


def spectral(tools: Path, document: Path) -> dict[str, list[str]]:
    """What Spectral says by rule, warnings included."""
    found = json.loads(
        run(
            *(tools / "spectral", "lint", document, "--ruleset", "spectral.yaml"),
            *("--format", "json", "--quiet"),
        )
    )
    return by_rule((each["code"], each["message"]) for each in found)


def damaged() -> Document:
    """A part of the document, with keywords unknown to OpenAPI 3.1 and less than it should say."""
    document = exported()
    followed = "/v1/fits/{fit_id}/events"
    document["paths"] = {followed: document["paths"][followed]}
    events = document["paths"][followed]["get"]["responses"]["200"]["content"]
    events["text/event-stream"]["itemSchema"] = {"type": "object"}
    schemas = document["components"]["schemas"]
    schemas["WebhookTarget"]["properties"]["url"]["ge"] = 1
    del schemas["BodyModels"]["properties"]["models"]["items"]
    return document


@pytest.mark.parametrize("linter", [redocly, spectral])
def test_a_linter_finds_nothing(tools: Path, linter):
    assert linter(tools, EXPORTED) == {}


@pytest.mark.parametrize(
    ("linter", "rules"),
    [(redocly, {"struct"}), (spectral, {"oas3-schema", "array-items"})],
)
def test_a_linter_finds_damage(tools: Path, tmp_path: Path, linter, rules: set[str]):
    document = tmp_path / "openapi.json"
    document.write_text(json.dumps(damaged()))
    assert rules <= set(linter(tools, document))
