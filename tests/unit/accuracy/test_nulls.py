"""What is told without a picture, and that the pages say the same."""

import re
from collections.abc import Mapping

import numpy as np
import pytest

from tests.accuracy.clothing_table import KNOWN
from tests.accuracy.nulls import NULLS, null_errors
from tests.accuracy.people_table import PEOPLE
from tests.accuracy.runs import picture_of
from tests.accuracy.scene import Half
from tests.accuracy.stance_kinds import Kind
from tests.integration.test_accuracy_page import PAGE, TABLES, cells

ROWS = {
    "no picture: the gender alone": "null: gender",
    "no picture: the height": "null: height",
    "no picture: height and weight": "null: height, weight",
}
COLUMNS = ("chest_girth", "waist_girth_smallest", "hip_girth", "weight")


@pytest.fixture(scope="module")
def errors() -> Mapping[str, Mapping[str, float]]:
    """Mean absolute errors of the reporting half, by what is known."""
    names = [
        f"{name}_{Kind.STANDING.value}"
        for name, source in PEOPLE.items()
        if source.half is Half.REPORTING
    ]
    found: dict[str, Mapping[str, float]] = {}
    for title, known in NULLS.items():
        of_people = [null_errors(picture_of(name), known) for name in names]
        found[title] = {
            key: float(np.mean([abs(each[key]) for each in of_people])) for key in of_people[0]
        }
    return found


def test_what_is_known_is_met(errors: Mapping[str, Mapping[str, float]]):
    assert errors["null: height, weight"]["weight"] < KNOWN
    assert errors["null: height"]["weight"] > 5.0


@pytest.mark.parametrize("row", ROWS)
def test_the_pages_say_what_is_printed(row: str, errors: Mapping[str, Mapping[str, float]]):
    told = errors[ROWS[row]]
    figures = [f"{told[key]:.1f}" if told[key] > KNOWN else "-" for key in COLUMNS]
    assert cells(PAGE, row)[:4] == figures
    waist = f"{told['waist_girth_navel']:.1f}"
    assert cells(TABLES, row)[:4] == [figures[0], waist, *figures[2:]]


def test_two_pictures_are_compared_with_none(errors: Mapping[str, Mapping[str, float]]):
    (part,) = re.findall(
        r"From the front and from the side\*.*?front and side \|", TABLES, re.DOTALL
    )
    assert (
        cells(part, "no picture: height and weight")[:4]
        == cells(PAGE, "no picture: height and weight")[:4]
    )
