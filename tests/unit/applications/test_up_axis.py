import numpy as np
import pytest

from fitter.applications.retarget import AXES, found_up_axis, given_up_axis

DIRECTIONS = dict(
    zip(AXES, [[0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1], [1, 0, 0], [-1, 0, 0]], strict=True)
)


@pytest.mark.parametrize("axis", AXES)
def test_every_axis_is_turned_to_the_worlds_up_without_mirroring(axis):
    found = given_up_axis(axis)
    np.testing.assert_array_equal(found.to_world @ DIRECTIONS[axis], [0, 1, 0])
    np.testing.assert_allclose(found.to_world @ found.to_world.T, np.eye(3))
    assert np.linalg.det(found.to_world) == pytest.approx(1.0)
    assert (found.axis, found.warnings) == (axis, ())


def test_a_file_whose_y_is_up_stays_as_it_is():
    np.testing.assert_array_equal(given_up_axis("y").to_world, np.eye(3))


@pytest.mark.parametrize("axis", AXES)
def test_up_is_where_heads_are_above_feet(axis):
    sway = np.random.default_rng(0).normal(scale=0.2, size=(50, 3))
    found = found_up_axis(np.array(DIRECTIONS[axis]) + sway)
    assert found.axis == axis
    # Nearly all files have y up; one that has not is either made so, or of somebody who lies.
    assert [warning.code for warning in found.warnings] == ["up-uncertain"] * (axis != "y")


def test_a_dance_on_the_floor_does_not_hide_that_most_frames_are_upright():
    frames = np.array([[0.0, 1.0, 0.0]] * 60 + [[0.0, 0.0, 1.0]] * 40)
    found = found_up_axis(frames)
    assert found.axis == "y"
    (warning,) = found.warnings
    assert warning.code == "up-uncertain"
    assert "60%" in warning.reason
    assert "`up`" in warning.remedy


def test_a_body_without_extent_gives_an_axis_and_a_doubt():
    found = found_up_axis(np.zeros((3, 3)))
    assert found.axis == "y"
    assert len(found.warnings) == 1
