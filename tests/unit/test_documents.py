"""What the pages say of fields, settings, limits, figures and versions is what the code has."""

import json
import re
import subprocess
from datetime import date
from pathlib import Path
from typing import Any

import pytest

from api_schemas.results import FitResult
from service.api.app import IDLE_S, openapi_text
from service.api.events import MAX_WAIT_S, PING_S
from service.api.openapi import recorded_examples
from service.settings import PREFIX, Settings
from service.version import VERSION
from tests.contract.document import exported
from tests.contract.request_table import PAGE, parts, request_table
from tests.readme import block


def test_the_fields_are_those_of_the_contract():
    assert parts(PAGE.read_text())[1] == request_table(), "python -m tests.contract.request_table"


def test_the_annotated_result_is_one():
    text = re.sub(r"\s+// .*", "", block("annotated result"))
    annotated = FitResult.model_validate_json(text)
    recorded = recorded_examples()["answers"]["get_fit_result"]["200"]["sample"]
    assert recorded.keys() <= json.loads(text).keys()
    assert annotated.verdict == "plausible"


ROOT = Path(__file__).parents[2]
OPERATE = ROOT / "service" / "docs" / "operate"
PAGES = sorted(OPERATE.glob("*.md"))
PROXY = (OPERATE / "proxy.md").read_text()
HEAD_S = 20


def setting(name: str) -> float:
    return Settings.model_fields[name].default


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_every_setting_named_is_one(page: Path):
    named = set(re.findall(rf"\b{PREFIX}([A-Z0-9_]+)\b", page.read_text()))
    assert {name.lower() for name in named} <= set(Settings.model_fields)


def seconds(name: str, text: str) -> float:
    (value,) = re.findall(rf"\b{name} (\d+)s", text)
    return float(value)


def test_nginx_waits_for_as_long_as_the_service_may_take():
    example = block("nginx", PROXY)
    (megabytes,) = re.findall(r"client_max_body_size (\d+)m;", example)
    assert int(megabytes) * 1024**2 >= setting("max_upload_bytes")
    assert seconds("client_header_timeout", example) == HEAD_S
    assert f"take longer than {HEAD_S} s" in PROXY
    assert seconds("client_body_timeout", example) == setting("body_time_limit_s")
    assert seconds("proxy_read_timeout", example) > max(MAX_WAIT_S, PING_S)
    assert seconds("keepalive_timeout", example) < IDLE_S


def test_caddy_waits_for_as_long_as_the_service_may_take():
    example = block("caddy", PROXY)
    (megabytes,) = re.findall(r"max_size (\d+)MB", example)
    assert int(megabytes) * 1000**2 >= setting("max_upload_bytes")
    assert seconds("response_header_timeout", example) > MAX_WAIT_S
    assert seconds("keepalive", example) < IDLE_S


SECTION = (ROOT / "service" / "docs" / "accuracy_tables.md").read_text()
FIGURES: dict[str, Any] = json.loads(
    (ROOT / "service" / "page" / "src" / "accuracy" / "figures.json").read_text()
)
ROWS = {
    ("pair", "front"): "front",
    ("pair", "frontAndSide"): "front and side",
    ("pair", "fourPictures"): "four pictures",
    ("pair", "weightGiven"): "front and side, weight given",
    ("single", "outline"): "SE: silhouette and edges",
    ("single", "shading"): "SES: and shading",
    ("single", "weightGiven"): "SES, weight given",
}


def told(row: str) -> list[float | None]:
    """Chest, waist, hip and weight of a row; None where the weight is given."""
    found = re.search(rf"^\s*\| {re.escape(row)} \|(.*)\|$", SECTION, re.MULTILINE)
    assert found, f"there is no row {row}"
    cells = [each.strip() for each in found[1].split("|")]
    return [None if each == "-" else float(each.split()[0]) for each in cells[:4]]


def test_no_row_of_the_page_is_left_out():
    assert {(table, row) for table in ("pair", "single") for row in FIGURES[table]} == set(ROWS)


@pytest.mark.parametrize(("at", "row"), ROWS.items())
def test_errors_are_those_of_the_tables(at: tuple[str, str], row: str):
    table, name = at
    shown = FIGURES[table][name]
    assert [shown[each] for each in ("chest", "waist", "hip", "weight")] == told(row)


def test_so_are_the_people_and_what_loose_clothes_cost():
    people = re.search(r"Of the (\w+) people of the\s+reporting half", SECTION)
    assert people
    assert people[1] == {12: "twelve"}[FIGURES["people"]]
    assert re.search(rf"is {FIGURES['looseWaist']} cm, and", SECTION)


NAMED = re.compile(r"\bmaquette[:-](\d+\.\d+\.\d+)\b|\bnewTag: (\S+)")
"""Images, wheels and archives."""

HEADING = re.compile(r"^## (.*)$", re.MULTILINE)


def test_the_contract_has_it():
    assert json.loads(openapi_text())["info"]["version"] == VERSION
    assert exported()["info"]["version"] == VERSION, "run `make openapi`"


def test_documents_and_manifests_name_no_other():
    if not (ROOT / ".git").exists():
        pytest.skip("no git to say which files are ours")
    command = ["git", "ls-files", "*.md", "*.yaml", "*.sh", "Makefile", "docker/Dockerfile"]
    listed = subprocess.run(command, cwd=ROOT, check=True, capture_output=True, text=True)
    named = {
        (name, "".join(found))
        for name in listed.stdout.splitlines()
        for found in NAMED.findall((ROOT / name).read_text())
    }
    assert {each for _, each in named} == {VERSION}, named


def test_the_changelog_s_newest_version_is_this_one_or_changes_wait_for_the_next():
    (first, waiting), (heading, changes), *_ = changelog()
    assert first == "Unreleased"
    newest, _, day = heading.partition(" - ")
    assert newest == VERSION or waiting.strip()
    assert date.fromisoformat(day)
    assert changes.strip(), "a version says what is new"


def changelog() -> list[tuple[str, str]]:
    """The changelog's sections, each by its heading."""
    parts = HEADING.split((ROOT / "CHANGELOG.md").read_text())[1:]
    return list(zip(parts[::2], parts[1::2], strict=True))
