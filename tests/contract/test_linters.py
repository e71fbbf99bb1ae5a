"""An independent linter has nothing to complain of in the document, and is awake."""

import json
import os
import subprocess
from collections.abc import Callable
from pathlib import Path

import pytest

from tests.contract.document import EXPORTED, Document, exported
from tests.external_tools import installed

pytestmark = pytest.mark.slow  # npm installs it

FOLDER = Path(__file__).parents[1] / "openapi_linters"
FOUND_SOMETHING = 1

Lint = Callable[[Path], set[str]]
"""The rules that a document breaks, those that warn included."""


@pytest.fixture
def lint() -> Lint:
    """Redocly, which is ended if it asks the network."""
    redocly = installed(FOLDER) / "node_modules" / ".bin" / "redocly"
    options = ("--config", "redocly.yaml", "--format", "json")
    quiet = {
        "NODE_OPTIONS": f"--require {FOLDER / 'offline.cjs'}",
        "REDOCLY_TELEMETRY": "off",
        "REDOCLY_SUPPRESS_UPDATE_NOTICE": "true",
    }

    def broken(document: Path) -> set[str]:
        done = subprocess.run(
            [redocly, "lint", document, *options],
            cwd=FOLDER,
            env=os.environ | quiet,
            capture_output=True,
            text=True,
            check=False,
        )
        assert done.returncode in {0, FOUND_SOMETHING}, done.stdout + done.stderr
        return {each["ruleId"] for each in json.loads(done.stdout)["problems"]}

    return broken


def damaged() -> Document:
    """A part of the document, with a keyword unknown to OpenAPI 3.1."""
    document = exported()
    followed = "/v1/fits/{fit_id}/events"
    document["paths"] = {followed: document["paths"][followed]}
    document["components"]["schemas"]["WebhookTarget"]["properties"]["url"]["ge"] = 1
    return document


def test_the_linter_finds_nothing(lint: Lint):
    assert lint(EXPORTED) == set()


def test_the_linter_finds_damage(lint: Lint, tmp_path: Path):
    document = tmp_path / "openapi.json"
    document.write_text(json.dumps(damaged()))
    assert "struct" in lint(document)
