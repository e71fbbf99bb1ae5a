"""Pictures are spoilt in the way that is said, and in no other."""

import io

import numpy as np
import pytest
from PIL import Image as PillowImage

from fitter.request import FitRequest
from tests.accuracy.people_table import PEOPLE
from tests.accuracy.runs import picture_of
from tests.accuracy.scene import Half
from tests.accuracy.spoilt import (
    AS_THEY_ARE,
    BESIDE_ANOTHER,
    CROPPED,
    KINDS,
    OCCLUDED,
    TOLD,
    Asked,
    Measured,
    asked_spoilt,
    spoilt_request,
)
from tests.accuracy.spoilt_table import spoilt_lines
from tests.accuracy.table import MEASUREMENTS

NAME, OTHER = "woman_young_thin_standing", "man_old_middling_standing"
KEYS = [key for _, key, _ in MEASUREMENTS]


def asked(kind: str, *, proposed: bool = False) -> Asked:
    return Asked(picture=NAME, other=OTHER, kind=kind, proposed=proposed, seed=0)


def request(kind: str) -> FitRequest:
    return spoilt_request(picture_of(NAME), asked(kind))


def pixels(of: FitRequest) -> np.ndarray:
    with PillowImage.open(io.BytesIO(of.views[0].image)) as picture:
        return np.asarray(picture.convert("RGB")).astype(int)


def measured(kind: str, error: float, *, withheld: bool = False, code: str = "") -> Measured:
    return Measured(
        asked=asked(kind),
        person="somebody",
        errors=dict.fromkeys(KEYS, error),
        standard_errors=dict.fromkeys(KEYS, 1.0),
        findings=(code,) if code else (),
        withheld=withheld,
    )


@pytest.mark.parametrize("kind", OCCLUDED)
def test_a_thing_hides_a_part_of_the_person_or_lies_beside_them_and_the_rest_is_as_it_was(
    kind: str,
):
    change = np.abs(pixels(request(kind)) - pixels(request(AS_THEY_ARE))).max(axis=2) > 30
    person = picture_of(NAME).person_mask
    assert 0.005 < change.mean() < 0.5
    hidden = (change & person).sum() / person.sum()
    if kind == "neighbour behind":
        assert hidden < 0.01
    else:
        assert 0.01 < hidden < 0.5


def test_who_clicks_a_hidden_point_guesses():
    clicks = request("box before the hips").views[0].clicks
    assert clicks["left_hip"].occluded
    assert clicks["right_hip"].occluded
    assert not clicks["left_knee"].occluded
    assert not request(AS_THEY_ARE).views[0].clicks["left_hip"].occluded


@pytest.mark.parametrize("kind", CROPPED)
def test_what_is_cropped_away_is_not_clicked(kind: str):
    cropped = request(kind)
    height = len(pixels(cropped))
    assert height < len(pixels(request(AS_THEY_ARE)))
    assert all(click.y < height for click in cropped.views[0].clicks.values())


def test_what_is_told_wrongly_is_all_that_changes():
    true = request(AS_THEY_ARE)
    for kind in TOLD:
        told = request(kind)
        assert told.views[0].image == true.views[0].image
        focal = told.views[0].focal_length_px != true.views[0].focal_length_px
        height = told.person.height_m != true.person.height_m
        assert (focal, height) == (kind.startswith("lens"), kind.startswith("height"))


def test_every_picture_is_asked_for_in_every_way_with_somebody_else_beside():
    names = [name for name in PEOPLE if PEOPLE[name].half is Half.TUNING][:3]
    found = asked_spoilt(names, KINDS)
    assert len(found) == 2 * 3 * len(KINDS)
    assert all(each.other != each.picture for each in found)
    assert set(BESIDE_ANOTHER) < set(OCCLUDED)


def test_of_what_is_withheld_nothing_counts_but_what_was_found():
    lines = spoilt_lines(
        [
            measured(AS_THEY_ARE, 1.0),
            measured(AS_THEY_ARE, -3.0, code="cut-off"),
            measured(AS_THEY_ARE, 30.0, withheld=True, code="cut-off"),
        ]
    )
    (line,) = lines
    assert "2.0 ±1.0 (-1.0)" in line
    assert line.split()[3:5] == ["clicked", "3"]
    assert "50 ±50" in line
    assert line.endswith("1  cut-off 2")
