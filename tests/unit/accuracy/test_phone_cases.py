import numpy as np
import pytest
from scipy.spatial import KDTree

from fitter.render.rasterizer import Rendering
from tests.accuracy.cases import CASES, PEOPLE
from tests.accuracy.clicks import hidden_points, noisy_clicks, rendering
from tests.accuracy.people import load_person, rig_of_people
from tests.accuracy.phone_cases import (
    BUSY_ROOMS,
    EQUIVALENT_MM,
    FARTHEST_M,
    HIGHEST_M,
    LOWEST_M,
    NEAREST_M,
    PHONE_CASES,
    PHONE_PAIRS,
    PhonePair,
)
from tests.accuracy.scene import Arm, Case, FocalLength, Half, Series
from tests.accuracy.staging import Staged, lamp_place, stage
from tests.unit.training.makehuman_data import needs_makehuman

PAIRS = list(PHONE_PAIRS.values())


def _is_stretched(arm: Arm) -> bool:
    return arm.raised > 60.0


def _staged(case: Case) -> Staged:
    return stage(load_person(PEOPLE[case.person]), case)


def test_everybody_has_one_pair_and_one_of_either_half_five_more():
    of_people = {case.person for case in CASES.values() if case.series is Series.PEOPLE}
    assert {pair.person for pair in PHONE_PAIRS.values()} == of_people
    assert len(PHONE_PAIRS) == len(of_people) == 24


@pytest.mark.parametrize("pair", PAIRS, ids=lambda pair: pair.front.name)
def test_a_person_turns_in_a_room_whose_camera_and_lamp_stay(pair: PhonePair):
    front, side = pair.front, pair.side
    assert (front.person, front.look, front.view) == (side.person, side.look, side.view)
    assert (front.lighting, front.surroundings) == (side.lighting, side.surroundings)
    assert front.surface_seed == side.surface_seed is not None
    assert abs(front.stance.facing) <= 10.0
    assert 80.0 <= abs(side.stance.facing) <= 100.0


def test_clicks_and_noise_of_no_two_pictures_are_alike():
    assert len({case.seed for case in CASES.values()}) == len(CASES)


@pytest.mark.parametrize("case", PHONE_CASES, ids=lambda case: case.name)
def test_a_phone_upright_about_two_metres_away_looks_a_little_down(case: Case):
    view = case.view
    assert 4 * view.width == 3 * view.height
    assert (view.equivalent_mm, case.focal_length) == (EQUIVALENT_MM, FocalLength.EXIF)
    assert NEAREST_M <= view.distance_m <= FARTHEST_M
    assert LOWEST_M <= view.height_m <= HIGHEST_M
    assert 0.0 < np.degrees(np.arctan2(view.height_m - view.aim_height_m, view.distance_m)) < 20.0


def test_arms_are_off_the_trunk_from_the_front_and_stretched_or_hanging_from_the_side():
    for pair in PAIRS:
        stance = pair.front.stance
        assert all(30.0 <= arm.raised <= 45.0 for arm in (stance.left_arm, stance.right_arm))
        arms = [
            _is_stretched(arm) for arm in (pair.side.stance.left_arm, pair.side.stance.right_arm)
        ]
        assert arms[0] == arms[1]


@pytest.mark.parametrize("half", Half)
def test_either_half_has_as_many_plain_rooms_as_busy_ones_and_sides_of_either_kind(half: Half):
    busy = {room.wall for room in BUSY_ROOMS}
    pairs = [pair for pair in PHONE_PAIRS.values() if PEOPLE[pair.person].half is half]
    assert sum(pair.front.surroundings.wall in busy for pair in pairs) == len(pairs) / 2
    stretched = [_is_stretched(pair.side.stance.left_arm) for pair in pairs]
    assert sum(stretched) == len(pairs) / 2
    assert len({pair.side.stance.facing > 0.0 for pair in pairs}) == 2
    assert len({pair.front.lighting.lamp.azimuth > 0.0 for pair in pairs}) == 2


@needs_makehuman
@pytest.mark.slow
@pytest.mark.parametrize("case", PHONE_CASES, ids=lambda case: case.name)
def test_forearms_and_hands_are_outside_the_body_and_the_lamp_outside_the_picture(case: Case):
    staged = _staged(case)
    seen = rendering(staged)
    names = np.array(rig_of_people().rig.bone_names)
    of_bone = names[np.asarray(rig_of_people().skin.toarray()).argmax(axis=1)]
    arms = _starts(of_bone, "lowerarm", "wrist", "finger", "metacarpal")
    rest = ~(arms | _starts(of_bone, "upperarm", "clavicle", "shoulder"))
    assert _deepest_m(seen, arms, rest) < 0.001
    lamp = staged.in_camera(lamp_place(staged, case.lighting.lamp))
    x, y = staged.camera.project(lamp)
    inside = 0.0 <= x <= staged.camera.width and 0.0 <= y <= staged.camera.height
    assert lamp[2] < 0.0 or not inside


@needs_makehuman
@pytest.mark.slow
def test_points_that_are_clicked_though_hidden_are_marked():
    pair = PHONE_PAIRS["phone_woman_young_thin"]
    for case in (pair.front, pair.side):
        staged = _staged(case)
        seen = rendering(staged)
        hidden = set(hidden_points(staged, seen))
        clicks = noisy_clicks(staged, seen, np.random.default_rng(0))
        guessed = {name for name, click in clicks.items() if click["visibility"] == 1}
        assert guessed == hidden & set(clicks)
        far = "left" if case.stance.facing > 0.0 else "right"
        if case is pair.side:
            assert {f"{far}_shoulder", f"{far}_hip", f"{far}_knee", f"{far}_eye"} <= hidden


def _starts(names: np.ndarray, *beginnings: str) -> np.ndarray:
    return np.array([name.startswith(beginnings) for name in names])


def _deepest_m(seen: Rendering, some: np.ndarray, others: np.ndarray) -> float:
    """How far some vertices lie under the surface of others near them, metres."""
    others_ids = np.flatnonzero(others)
    distance, nearest = KDTree(seen.vertices[others]).query(seen.vertices[some])
    under = others_ids[nearest]
    offset = seen.vertices[some] - seen.vertices[under]
    depth = -np.einsum("ki,ki->k", offset, seen.vertex_normals[under])
    return float(depth[distance < 0.08].max(initial=0.0))
