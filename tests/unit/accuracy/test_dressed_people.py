from collections import Counter

import numpy as np

from tests.accuracy.dressed_people import DRESSED, IN_PAIRS, PAIRS_OF_HALF
from tests.accuracy.outfits import Wardrobe, drawn_outfit
from tests.accuracy.people_table import PEOPLE, SITTERS
from tests.accuracy.scene import Half

SKIN = (0.5, 0.3, 0.2)


def test_everybody_of_both_halves_is_dressed_once():
    assert Counter(each.person for each in DRESSED) == dict.fromkeys(
        (sitter.source.name for sitter in SITTERS), 1
    )


def test_either_half_wears_every_class_that_is_drawn_and_shirts_and_dresses():
    for half in Half:
        worn = {each.outfit.name for each in DRESSED if PEOPLE[each.person].half is half}
        assert worn == {kind.value for kind in Wardrobe}


def test_people_in_pairs_are_of_both_halves():
    assert Counter(PEOPLE[person].half for person in IN_PAIRS) == dict.fromkeys(Half, PAIRS_OF_HALF)


def test_an_outfit_is_drawn_again_from_its_seed_and_others_from_others():
    first, again, other = (
        drawn_outfit(Wardrobe.HOODIE, SKIN, np.random.default_rng(seed)) for seed in (1, 1, 2)
    )
    assert first == again != other


def test_soles_are_one_to_three_centimetres_thick():
    rng = np.random.default_rng(0)
    soles = [drawn_outfit(Wardrobe.T_SHIRT, SKIN, rng).sole_m for _ in range(100)]
    shod = [sole for sole in soles if sole > 0.0]
    assert 60 < len(shod) < 95
    assert 0.01 <= min(shod) < max(shod) <= 0.03


def test_cloth_near_the_skins_colour_is_near_it_and_jackets_stand_off_farther_than_shirts():
    rng = np.random.default_rng(0)
    like_skin = drawn_outfit(Wardrobe.LIKE_SKIN, SKIN, rng).top
    jacket = drawn_outfit(Wardrobe.JACKET, SKIN, rng)
    assert like_skin is not None
    assert jacket.top is not None
    assert jacket.jacket is not None
    np.testing.assert_allclose(like_skin.cloth.colour, SKIN, rtol=0.4)
    assert jacket.jacket.cloth.ease_m > 2.0 * jacket.top.cloth.ease_m
    assert jacket.jacket.clearance_m > jacket.top.clearance_m
