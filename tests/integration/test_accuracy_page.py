"""The page about accuracy: commands that exist, figures that the tables have."""

import re
import shlex
from collections.abc import Mapping
from pathlib import Path

import numpy as np
import pytest

from tests.accuracy.__main__ import parser
from tests.accuracy.clothing_table import KNOWN
from tests.accuracy.nulls import NULLS, null_errors
from tests.accuracy.people_table import PEOPLE
from tests.accuracy.runs import picture_of
from tests.accuracy.scene import Half, Kind

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "service" / "docs" / "accuracy.md").read_text()
README = (ROOT / "README.md").read_text()
TABLES = (ROOT / "service" / "docs" / "accuracy_tables.md").read_text()

ROUNDED = 0.051
"""How far a figure to one place may lie from the same one to two."""

OPTIONS = sorted(set(re.findall(r"`(?:python -m tests\.accuracy )?(--[^`]+)`", PAGE)))


def cells(text: str, row: str) -> list[str]:
    """The cells of a table's row, whatever stands around it."""
    found = re.search(rf"^ *\| {re.escape(row)} \|(.*)\|$", text, re.MULTILINE)
    assert found, row
    return [each.strip() for each in found[1].split("|")]


def test_commands_are_found():
    assert "--scan --half reporting" in OPTIONS
    assert len(OPTIONS) > 8


@pytest.mark.parametrize("options", OPTIONS)
def test_every_command_is_understood(options: str):
    parser().parse_args(shlex.split(options))


@pytest.mark.parametrize(
    ("ours", "table"),
    [
        ("one front picture of a phone", "front"),
        ("front and side", "front and side"),
        ("front and side, and the weight", "front and side, weight given"),
        ("four pictures", "four pictures"),
    ],
)
def test_phone_pictures_err_as_the_tables_say(ours: str, table: str):
    assert cells(PAGE, ours)[:5] == cells(TABLES, table)


@pytest.mark.parametrize(
    "row", ["one front picture of a phone", "front and side", "front and side, and the weight"]
)
def test_the_readme_promises_no_more(row: str):
    assert cells(README, row) == cells(PAGE, row)[:5]


def test_a_known_weight_is_worth_what_the_tables_say():
    chest, waist, hip = cells(TABLES, "SES, weight given")[:3]
    told = [chest.split()[0], f"{waist.split()[0]} (navel)", hip.split()[0]]
    assert cells(PAGE, "and the weight")[:3] == told


@pytest.mark.parametrize(
    ("ours", "table"), [("SE", "SE: silhouette and edges"), ("SES", "SES: and shading")]
)
def test_one_picture_errs_as_the_tables_say(ours: str, table: str):
    chest, _, hip, weight, navel = (float(each.split()[0]) for each in cells(PAGE, ours))
    told = [float(each.split()[0]) for each in cells(TABLES, table)[:4]]
    assert [chest, navel, hip, weight] == pytest.approx(told, abs=ROUNDED)


def test_medians_of_one_picture_are_those_of_the_tables():
    chest, _, hip, weight, navel = map(float, cells(PAGE, "SES, median"))
    told = [float(each.split()[1].strip("()")) for each in cells(TABLES, "SES: and shading")[:4]]
    assert [chest, navel, hip, weight] == pytest.approx(told, abs=ROUNDED)


def test_women_and_men_together_are_everybody():
    women, men, all_people = (
        [float(each.split()[0]) for each in cells(PAGE, row)] for row in ("women", "men", "SES")
    )
    both = [(one + other) / 2 for one, other in zip(women, men, strict=True)]
    assert both == pytest.approx(all_people, abs=2 * ROUNDED)


def test_shares_in_sentences_are_those_of_the_tables():
    page, tables = (" ".join(each.split()) for each in (PAGE, TABLES))
    truths, within = re.findall(r"Of (\d+) truths (\d+) lie in these intervals", page)[0]
    assert f"95 % intervals of SES hold {100 * int(within) / int(truths):.0f} %" in tables
    (wrong,) = re.findall(r"In (\d+ of) the 36 a limb slants the wrong way", page)
    assert f"In {wrong} 36 a limb" in tables
    degrees = re.findall(r"the lamp's direction ([\d.]+) degrees", page)[0]
    assert f"within {degrees} degrees. Shading improves" in tables
    joints = cells(TABLES, "SES: and shading")[5]
    assert f"The joints are {joints} mm off on the mean" in page


@pytest.fixture(scope="module")
def nulls() -> Mapping[str, Mapping[str, float]]:
    """Mean absolute errors of the reporting half without a picture, by what is known."""
    pictures = [
        picture_of(f"{name}_{Kind.STANDING}")
        for name, source in PEOPLE.items()
        if source.half is Half.REPORTING
    ]
    found: dict[str, dict[str, float]] = {}
    for title, known in NULLS.items():
        errors = [null_errors(picture, known) for picture in pictures]
        found[title] = {
            key: float(np.mean([abs(each[key]) for each in errors])) for key in errors[0]
        }
    return found


@pytest.mark.parametrize(
    ("row", "title"),
    [
        ("no picture: the gender alone", "null: gender"),
        ("no picture: the height", "null: height"),
        ("no picture: height and weight", "null: height, weight"),
    ],
)
def test_the_pages_say_what_is_known_without_a_picture(
    row: str, title: str, nulls: Mapping[str, Mapping[str, float]]
):
    told = nulls[title]
    keys = ("chest_girth", "waist_girth_smallest", "hip_girth", "weight")
    figures = [f"{told[key]:.1f}" if told[key] > KNOWN else "-" for key in keys]
    assert cells(PAGE, row)[:4] == figures
    waist = f"{told['waist_girth_navel']:.1f}"
    assert cells(TABLES, row)[:4] == [figures[0], waist, *figures[2:]]
    part = TABLES[TABLES.index("*From the front and from the side*") :]
    if row != "no picture: the gender alone":
        assert cells(part, row)[:4] == figures
