"""Paint lies where it is said to lie, and the table counts what people are taken to wear."""

import io
from functools import cache

import numpy as np
import pytest
from PIL import Image as PillowImage

from fitter.vocabulary.choices import BodyRegion, Covering
from tests.accuracy.covers import (
    AS_THEY_ARE,
    IN_UNDERWEAR,
    ON_ANYBODY,
    Covered,
    CoveredFit,
    asked_covers,
    covered_picture,
)
from tests.accuracy.covers_table import covers_line
from tests.accuracy.runs import picture_of
from tests.accuracy.table import MEASUREMENTS

NAME = "man_middle_aged_middling_standing"
KEYS = [key for _, key, _ in MEASUREMENTS]


@cache
def pixels(kind: str) -> np.ndarray:
    request = covered_picture(Covered(picture=NAME, kind=kind, number=1)).request
    with PillowImage.open(io.BytesIO(request.views[0].image)) as picture:
        return np.asarray(picture.convert("RGB")).astype(int)


def changed(kind: str) -> np.ndarray:
    return np.abs(pixels(kind) - pixels(AS_THEY_ARE)).max(axis=2) > 20


@pytest.mark.parametrize(
    ("kind", "least", "most"),
    [
        ("gloves", 0.01, 0.06),
        ("face mask", 0.005, 0.04),
        ("beard", 0.002, 0.03),
        ("stockings", 0.12, 0.5),
        ("open vest, leggings", 0.25, 0.6),
        ("dark skin", 0.6, 0.95),
        ("cloth of the skin's colour", 0.08, 0.25),
    ],
)
def test_so_much_of_the_person_is_painted_and_hardly_anything_beside(
    kind: str, least: float, most: float
):
    person = picture_of(NAME).person_mask
    painted = changed(kind)
    assert least < (painted & person).sum() / person.sum() < most
    assert (painted & ~person).sum() < 0.2 * painted.sum()


def test_gloves_are_at_the_height_of_the_hips_and_a_mask_is_above_the_shoulders():
    clicks = picture_of(NAME).request.views[0].clicks
    gloves, mask = (np.nonzero(changed(kind))[0] for kind in ("gloves", "face mask"))
    assert np.median(gloves) > clicks["left_elbow"].y
    assert mask.max() < clicks["left_shoulder"].y


def test_people_in_clothes_wear_neither_stockings_nor_a_vest_over_them():
    asked = asked_covers(["somebody"], ["clothed"])
    assert [each.kind for each in asked if each.picture == "somebody"] == list(IN_UNDERWEAR)
    assert [each.kind for each in asked if each.picture == "clothed"] == list(ON_ANYBODY)


def test_a_line_counts_coverings_errors_intervals_and_findings():
    these = [
        CoveredFit(
            asked=Covered(picture=NAME, kind="gloves", number=0),
            dressed=False,
            errors=dict.fromkeys(KEYS, error),
            standard_errors=dict.fromkeys(KEYS, 1.0),
            worn={BodyRegion.UPPER: kind},
            findings=("skin-not-found",),
        )
        for error, kind in ((1.0, Covering.BARE), (-3.0, Covering.LOOSE))
    ]
    line = covers_line(these)
    assert "1/0/1" in line
    assert "2.0 ±1.0 (-1.0)" in line
    assert "50 ±50" in line
    assert line.endswith("skin-not-found 2")
