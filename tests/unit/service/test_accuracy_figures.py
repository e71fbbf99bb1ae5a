"""The figures that the page shows are those of the tables of accuracy."""

import json
import re
from pathlib import Path
from typing import Any

import pytest

ROOT = Path(__file__).parents[3]
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
