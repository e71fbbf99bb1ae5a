"""Lee and Chen's and Taylor's constructions."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fitter.pose_init.lifting import FAR, NEAR, OrthographicLifting, PerspectiveLifting
from fitter.render.camera import Camera

CAMERA = Camera(focal_length_px=600.0, centre_x=320.0, centre_y=240.0, width=640, height=480)
LEE_CHEN = PerspectiveLifting(camera=CAMERA)
TAYLOR = OrthographicLifting(camera=CAMERA, scale=200.0)

coordinates = st.tuples(st.floats(-0.8, 0.8), st.floats(-0.8, 0.8), st.floats(2.0, 5.0))


@given(coordinates, coordinates)
def test_the_true_end_of_a_limb_is_one_of_two_solutions(near_end, far_end):
    known, end = np.array(near_end), np.array(far_end)
    length = float(np.linalg.norm(end - known))
    ends = LEE_CHEN.reach(known, CAMERA.project(end), length)
    # Where the ray grazes the sphere the depth is the square root of a rounding error.
    assert np.linalg.norm(ends.points - end, axis=-1).min() < 1e-6
    assert ends.overreach_m == pytest.approx(0.0, abs=1e-9)


@given(coordinates, st.floats(0.1, 0.6), st.floats(-100, 100), st.floats(-100, 100))
def test_both_solutions_lie_on_the_ray_and_on_the_sphere_the_nearer_first(known, length, du, dv):
    known = np.array(known)
    pixel = CAMERA.project(known) + 0.5 * np.array([du, dv])
    ends = LEE_CHEN.reach(known, pixel, length)
    np.testing.assert_allclose(CAMERA.project(ends.points), np.tile(pixel, (2, 1)), atol=1e-8)
    np.testing.assert_allclose(
        np.linalg.norm(ends.points - known, axis=-1), length + ends.overreach_m, atol=1e-8
    )
    assert ends.points[NEAR, 2] <= ends.points[FAR, 2]


def test_a_limb_too_long_in_the_image_ends_at_the_nearest_point_and_says_by_how_much():
    known = np.array([0.0, 0.0, 3.0])
    target = np.array([0.5, 0.0, 3.0])
    ends = LEE_CHEN.reach(known, CAMERA.project(target), 0.3)
    ray = target / np.linalg.norm(target)
    distance = np.linalg.norm(known - (known @ ray) * ray)
    np.testing.assert_allclose(ends.points[NEAR], ends.points[FAR])
    assert ends.overreach_m == pytest.approx(distance - 0.3)


@given(coordinates, coordinates)
def test_the_true_ends_of_a_cross_piece_are_one_of_two_solutions(one, other):
    first, second = np.array(one), np.array(other)
    second[2] = first[2] + 0.3 * (second[2] - 3.5)
    width = float(np.linalg.norm(second - first))
    if width < 0.05:
        return
    ends = LEE_CHEN.spread(
        np.array(0.5 * (first[2] + second[2])),
        CAMERA.project(first),
        CAMERA.project(second),
        width,
    )
    error = np.linalg.norm(ends.first - first, axis=-1) + np.linalg.norm(
        ends.second - second, axis=-1
    )
    assert error.min() < 1e-5
    assert ends.second[NEAR, 2] <= ends.second[FAR, 2]


def test_similar_triangles_give_the_depth_of_a_parallel_limb():
    ends = np.array([[-0.2, 0.1, 3.7], [0.2, -0.1, 3.7]])
    pixels = CAMERA.project(ends)
    length = float(np.linalg.norm(ends[1] - ends[0]))
    assert LEE_CHEN.parallel_depth(pixels[0], pixels[1], length) == pytest.approx(3.7)


def test_taylor_recovers_an_orthographic_limb_exactly():
    known, end = np.array([0.1, 0.2, 3.0]), np.array([0.3, -0.1, 2.8])
    pixel = TAYLOR.scale * end[:2] + [CAMERA.centre_x, CAMERA.centre_y]
    ends = TAYLOR.reach(known, pixel, float(np.linalg.norm(end - known)))
    np.testing.assert_allclose(ends.points[NEAR], end, atol=1e-9)
    np.testing.assert_allclose(ends.points[FAR], [0.3, -0.1, 3.2], atol=1e-9)


def test_taylor_and_lee_chen_agree_far_away():
    distance = 1000.0
    camera = Camera(focal_length_px=2e5, centre_x=320.0, centre_y=240.0, width=640, height=480)
    known, end = np.array([0.0, 0.2, distance]), np.array([0.3, -0.1, distance - 0.25])
    length = float(np.linalg.norm(end - known))
    pixel = camera.project(end)
    perspective = PerspectiveLifting(camera=camera).reach(known, pixel, length)
    orthographic = OrthographicLifting(camera=camera, scale=200.0).reach(known, pixel, length)
    np.testing.assert_allclose(perspective.points, orthographic.points, atol=2e-3)


def test_a_batch_of_known_ends_gives_the_same_as_each_alone():
    known = np.array([[0.0, 0.0, 3.0], [0.1, 0.1, 3.3]])
    pixel = np.array([350.0, 260.0])
    for lifting in (LEE_CHEN, TAYLOR):
        together = lifting.reach(known, pixel, 0.4)
        alone = lifting.reach(known[1], pixel, 0.4)
        np.testing.assert_allclose(together.points[1], alone.points)
