"""Clothing: what is said, what is worn, and its usual ease."""

from dataclasses import replace

import numpy as np
import pytest

from fitter.detection.worn_parts import WornShares
from fitter.energies.scales import EASE_MEAN_M
from fitter.fits.clothing_report import worn_regions
from fitter.fits.ease import TopShares, shares_by_sleeves, usual_fullness, worn_over
from fitter.segmentation.coverage import Coverage
from fitter.segmentation.skin_colour import PersonRegions, SkinMap
from fitter.vocabulary.choices import BodyRegion, Covering, Gender
from tests.accuracy.people import packaged_model

SIDE = 20
WORN_PARTS = ("head", "chest", "left_upper_arm", "pelvis", "left_thigh", "left_shin", "left_foot")
"""Pixels of a part each way; the parts lie side by side."""

NOTHING = np.zeros((SIDE, SIDE * len(WORN_PARTS)), dtype=np.bool_)
NO_SKIN = SkinMap(probability=NOTHING.astype(np.float32), coloured=NOTHING, learnt_from=())
COVERED = Coverage(top=1.0, bottom=1.0, top_like_skin=0.0, bottom_like_skin=0.0)


def regions(unseen: tuple[str, ...] = ()) -> PersonRegions:
    parts = np.repeat(np.arange(len(WORN_PARTS)), SIDE)[None].repeat(SIDE, axis=0)
    return PersonRegions(
        person=~np.isin(parts, [WORN_PARTS.index(name) for name in unseen]),
        parts=parts,
        part_names=WORN_PARTS,
        face=None,
        pixels_per_metre=300.0,
    )


def of_parts(**values: float) -> np.ndarray:
    """(h, w) a value for each part, 0 where none is said."""
    of_part = np.array([values.get(name, 0.0) for name in WORN_PARTS], dtype=np.float32)
    return of_part[regions().parts]


def kinds(bare: np.ndarray, loose: np.ndarray) -> dict[BodyRegion, Covering]:
    found = worn_regions(regions(), NO_SKIN, COVERED, bare=bare, loose=loose)
    return {each.region: each.kind for each in found}


def test_a_shirt_above_leggings():
    found = kinds(of_parts(left_upper_arm=0.9), of_parts(chest=0.9, left_upper_arm=0.9))
    assert found == {
        BodyRegion.UPPER: Covering.LOOSE,
        BodyRegion.ARMS: Covering.BARE,
        BodyRegion.LOWER: Covering.CLOSE,
        BodyRegion.LEGS: Covering.CLOSE,
        BodyRegion.FEET: Covering.CLOSE,
    }


def test_shoes_are_never_loose():
    everything = np.ones((SIDE, SIDE * len(WORN_PARTS)), dtype=np.float32)
    assert kinds(0.0 * everything, everything)[BodyRegion.FEET] is Covering.CLOSE


def test_people_in_underwear_are_bare_as_probably_as_nothing_covers_them():
    covered = Coverage(top=0.1, bottom=0.2, top_like_skin=0.0, bottom_like_skin=0.0)
    found = worn_regions(regions(), NO_SKIN, covered, bare=None, loose=None)
    told = {each.region: each.probability for each in found}
    assert {each.kind for each in found} == {Covering.BARE}
    assert told[BodyRegion.UPPER] == pytest.approx(0.9)
    assert told[BodyRegion.LEGS] == pytest.approx(0.8)


def test_of_what_is_out_of_sight_nothing_is_told():
    found = worn_regions(regions(unseen=("left_shin",)), NO_SKIN, COVERED, bare=None, loose=None)
    assert BodyRegion.LEGS not in {each.region for each in found}


@pytest.mark.parametrize(
    ("skin_share", "kind", "probability"),
    [(0.6, Covering.BARE, 0.6), (0.2, Covering.LOOSE, 0.8)],
    ids=["face", "hair or a hat"],
)
def test_heads_are_covered_where_little_skin_shows(skin_share, kind, probability):
    rows = np.arange(SIDE)[:, None] < round(skin_share * SIDE)
    skin = replace(NO_SKIN, coloured=rows & (regions().parts == 0), learnt_from=("face",))
    found = worn_regions(regions(), skin, COVERED, bare=None, loose=None)
    (head,) = [each for each in found if each.region is BodyRegion.HEAD]
    assert head.kind is kind
    assert head.probability == pytest.approx(probability)


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


def forearms(*, seen: bool) -> PersonRegions:
    parts = np.repeat([[0] * 20 + [1] * 20], 20, axis=0)
    return PersonRegions(
        person=np.full(parts.shape, True) if seen else parts == 0,
        parts=parts,
        part_names=("chest", "left_forearm"),
        face=None,
        pixels_per_metre=300.0,
    )


def test_a_top_that_covers_forearms_is_wider():
    dressed, bare = (np.full((20, 40), share, dtype=np.float32) for share in (0.0, 1.0))
    long, short = (shares_by_sleeves(forearms(seen=True), each) for each in (dressed, bare))
    assert long.trunk > short.trunk < long.any_trunk
    assert long.arms > short.arms
    assert shares_by_sleeves(forearms(seen=False), bare) == TopShares()


def test_outer_cloth_counts_where_it_shows_on_who_wears_it():
    regions = forearms(seen=True)
    shown = np.where(np.indices(regions.parts.shape)[1] % 3 > 0, np.float32(0.8), np.float32(0.05))
    jacket, shirt = (
        np.array(worn_over(WornShares(skin=0.0 * shown, outer=share * shown), regions))
        for share in (1.0, 0.2)
    )
    assert ((jacket > 0.9) == (shown > 0.5)).all()
    assert shirt.max() < 0.1
    assert worn_over(None, regions) is None
