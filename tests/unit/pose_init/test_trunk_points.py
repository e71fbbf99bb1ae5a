"""The trunk's corners, clicked or guessed."""

import numpy as np
import pytest

from fitter.errors import InvalidInputError
from fitter.pose_init.click_problem import ClickedPoints, clicked_points
from fitter.pose_init.trunk import trunk_points
from fitter.request import Click
from tests.unit.pose_init.scenes import LENGTHS

FRONT = {
    "right_shoulder": (100.0, 100.0),
    "left_shoulder": (200.0, 110.0),
    "right_hip": (120.0, 260.0),
    "left_hip": (175.0, 262.0),
}


def points(**pixels: tuple[float, float]) -> ClickedPoints:
    return clicked_points({name: Click(x=x, y=y) for name, (x, y) in pixels.items()})


def without(*names: str) -> dict[str, tuple[float, float]]:
    return {name: pixel for name, pixel in FRONT.items() if name not in names}


def test_clicked_corners_stay_and_middles_are_added():
    trunk = trunk_points(points(**FRONT), LENGTHS)
    assert not trunk.guessed
    np.testing.assert_allclose(trunk.pixels["pelvis_middle"], [147.5, 261.0])
    np.testing.assert_allclose(trunk.pixels["thorax_middle"], [150.0, 105.0])


@pytest.mark.parametrize("name", list(FRONT))
def test_a_missing_corner_keeps_the_slant_of_the_other_pair(name):
    trunk = trunk_points(points(**without(name)), LENGTHS)
    assert trunk.guessed == {name}
    shoulders = trunk.pixels["left_shoulder"] - trunk.pixels["right_shoulder"]
    hips = trunk.pixels["left_hip"] - trunk.pixels["right_hip"]
    assert shoulders[0] * hips[1] - shoulders[1] * hips[0] == pytest.approx(0.0, abs=1e-9)
    assert shoulders @ hips > 0.0


def test_hips_out_of_the_picture_lie_below_the_shoulders():
    trunk = trunk_points(points(**without("right_hip", "left_hip"), nose=(150.0, 40.0)), LENGTHS)
    assert trunk.pixels["pelvis_middle"][1] > 150.0
    assert trunk.pixels["left_hip"][0] > trunk.pixels["right_hip"][0]


def test_hips_of_a_person_upside_down_lie_above_the_shoulders():
    trunk = trunk_points(points(**without("right_hip", "left_hip"), nose=(150.0, 170.0)), LENGTHS)
    assert trunk.pixels["pelvis_middle"][1] < 50.0


def test_shoulders_out_of_the_picture_lie_on_the_other_side_of_the_knees():
    trunk = trunk_points(
        points(**without("right_shoulder", "left_shoulder"), left_knee=(180.0, 400.0)), LENGTHS
    )
    assert trunk.pixels["thorax_middle"][1] < 200.0


def test_one_side_alone_is_a_side_view():
    trunk = trunk_points(points(**without("right_shoulder", "right_hip")), LENGTHS)
    np.testing.assert_allclose(trunk.pixels["right_hip"], trunk.pixels["left_hip"])
    np.testing.assert_allclose(trunk.pixels["right_shoulder"], trunk.pixels["left_shoulder"])


@pytest.mark.parametrize("kept", [(), ("left_hip",), ("right_shoulder",)])
def test_too_little_of_the_trunk_is_refused_with_a_remedy(kept):
    with pytest.raises(InvalidInputError) as refused:
        trunk_points(points(**{name: FRONT[name] for name in kept}), LENGTHS)
    assert refused.value.field == "points"
    assert "Click" in refused.value.remedy
