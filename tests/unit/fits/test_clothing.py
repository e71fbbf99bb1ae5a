"""When clothes said to be loose are hardly there."""

import numpy as np
import pytest

from fitter.fits.clothing import looks_undressed
from fitter.segmentation.skin_colour import PersonRegions, SkinMap

PARTS = ("head", "pelvis", "spine", "chest", "left_thigh", "right_thigh")
SIDE = 20
"""Pixels of a part each way; the parts lie side by side."""


def _shown(bare: dict[str, float], unseen: tuple[str, ...] = ()) -> tuple[SkinMap, PersonRegions]:
    """Parts of which a share has the skin's colour."""
    parts = np.repeat(np.arange(len(PARTS)), SIDE)[None].repeat(SIDE, axis=0)
    person = ~np.isin(parts, [PARTS.index(name) for name in unseen])
    coloured = np.zeros(parts.shape, dtype=np.bool_)
    for name, share in bare.items():
        coloured[: round(share * SIDE)] |= parts[: round(share * SIDE)] == PARTS.index(name)
    skin = SkinMap(
        probability=np.zeros(parts.shape, dtype=np.float32),
        coloured=coloured & person,
        learnt_from=("face",),
    )
    regions = PersonRegions(
        person=person, parts=parts, part_names=PARTS, face=None, pixels_per_metre=300.0
    )
    return skin, regions


UNDERWEAR = {"head": 1.0, "spine": 1.0, "chest": 0.5, "left_thigh": 0.9, "right_thigh": 0.8}


def test_underwear_is_not_loose():
    assert looks_undressed(*_shown(UNDERWEAR))


@pytest.mark.parametrize(
    "bare",
    [
        {"head": 1.0},
        {"head": 1.0, "spine": 1.0, "chest": 1.0},
        {"head": 1.0, "left_thigh": 0.7, "right_thigh": 0.7, "chest": 0.2},
    ],
    ids=["dressed", "bare above trousers", "shorts and shirt"],
)
def test_clothes_that_hide_trunk_or_thighs_may_be_loose(bare):
    assert not looks_undressed(*_shown(bare))


def test_thighs_out_of_sight_say_nothing():
    hidden = ("left_thigh", "right_thigh")
    assert not looks_undressed(*_shown(UNDERWEAR, unseen=hidden))
    assert looks_undressed(*_shown(UNDERWEAR, unseen=hidden[:1]))
