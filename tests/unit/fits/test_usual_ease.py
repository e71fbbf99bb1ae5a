"""The usual ease over a body of the packaged models."""

import numpy as np
import pytest

from fitter.energies.scales import EASE_MEAN_M
from fitter.fits.clothing import (
    LONG_SLEEVED,
    SHORT_SLEEVED,
    USUAL_EASE_M,
    share_by_sleeves,
    usual_fullness,
)
from fitter.segmentation.skin_colour import PersonRegions
from fitter.vocabulary.choices import Gender
from tests.accuracy.landmark_points import packaged_model


@pytest.fixture(scope="module", params=list(Gender))
def model(request):
    return packaged_model(request.param)


def of(model, part: str) -> np.ndarray:
    number = model.part_names.index(part)
    vertices = np.unique(model.triangles[model.part_of_triangle == number])
    return EASE_MEAN_M * usual_fullness(model)[vertices]


def test_cloth_lies_on_shoulders_and_hangs_away_from_shins(model):
    assert of(model, "neck").sum(axis=1).mean() < 0.01
    assert 0.02 < of(model, "spine").sum(axis=1).mean() < 0.03
    assert of(model, "left_shin").sum(axis=1).mean() > 0.035


def test_both_sides_hang_alike(model):
    fullness = usual_fullness(model)
    np.testing.assert_allclose(fullness, fullness[model.mirror], atol=0.15)


def test_shirts_say_nothing_of_shins_and_trousers_nothing_of_arms(model):
    assert of(model, "right_shin")[:, 0].max() < 0.002
    assert of(model, "left_forearm")[:, 1].max() < 1e-12


def test_every_part_has_its_ease(model):
    kinds = {name.removeprefix("left_").removeprefix("right_") for name in model.part_names}
    assert kinds == set(USUAL_EASE_M)


def forearms(*, seen: bool) -> PersonRegions:
    parts = np.repeat([[0] * 20 + [1] * 20], 20, axis=0)
    return PersonRegions(
        person=np.full(parts.shape, True) if seen else parts == 0,
        parts=parts,
        part_names=("chest", "left_forearm"),
        face=None,
        pixels_per_metre=300.0,
    )


@pytest.mark.parametrize(
    ("bare", "share"),
    [(1.0, SHORT_SLEEVED), (0.0, LONG_SLEEVED), (0.5, (SHORT_SLEEVED + LONG_SLEEVED) / 2.0)],
)
def test_a_top_that_covers_forearms_is_wider(bare, share):
    everywhere = np.full((20, 40), bare, dtype=np.float32)
    assert share_by_sleeves(forearms(seen=True), everywhere) == pytest.approx(share)
    assert share_by_sleeves(forearms(seen=False), everywhere) == 1.0
