import numpy as np
import pytest

from fitter.evidence.silhouette_evidence import signed_distance, silhouette_evidence

HEIGHT, WIDTH = 240, 320
ROWS, COLUMNS = np.mgrid[:HEIGHT, :WIDTH] + 0.5
CENTRE = np.array([160.3, 120.7])


def disc(radius: float) -> np.ndarray:
    return np.hypot(COLUMNS - CENTRE[0], ROWS - CENTRE[1]) < radius


def radii(points: np.ndarray) -> np.ndarray:
    return np.linalg.norm(points - CENTRE, axis=1)


@pytest.mark.parametrize("radius", [15.3, 40.3, 90.2])
def test_signed_distance_is_that_of_the_disc_to_half_a_pixel(radius: float):
    expected = np.hypot(COLUMNS - CENTRE[0], ROWS - CENTRE[1]) - radius
    error = signed_distance(disc(radius)) - expected
    assert np.abs(error).max() < 0.75
    # Far outside, the nearest of many pixel centres is nearer than the disc by up to half a pixel.
    assert abs(error[np.abs(expected) < 3].mean()) < 0.1


def test_signed_distance_is_negative_inside_and_positive_outside():
    mask = disc(40)
    distance = signed_distance(mask)
    assert (distance[mask] < 0).all()
    assert (distance[~mask] > 0).all()


def test_the_outline_of_a_rectangle_runs_between_the_pixels():
    mask = np.zeros((60, 80), dtype=np.bool_)
    mask[20:40, 30:60] = True
    distance = signed_distance(mask)
    assert distance[30, 29] == pytest.approx(0.5)
    assert distance[30, 30] == pytest.approx(-0.5)
    evidence = silhouette_evidence(mask)
    middle = np.abs(evidence.boundary_points[:, 1] - 30) < 5
    sides = evidence.boundary_points[middle, 0]
    np.testing.assert_allclose(np.minimum(np.abs(sides - 30), np.abs(sides - 60)), 0, atol=0.01)


@pytest.mark.parametrize("radius", [15.3, 40.3, 90.2])
def test_boundary_points_lie_on_the_disc_to_a_fraction_of_a_pixel(radius: float):
    evidence = silhouette_evidence(disc(radius))
    error = radii(evidence.boundary_points) - radius
    assert np.sqrt((error**2).mean()) < 0.16
    assert abs(error.mean()) < 0.1


def test_boundary_normals_point_outward_with_unit_length():
    evidence = silhouette_evidence(disc(40.3))
    outward = (evidence.boundary_points - CENTRE) / radii(evidence.boundary_points)[:, None]
    np.testing.assert_allclose(np.linalg.norm(evidence.boundary_normals, axis=1), 1, rtol=1e-6)
    assert ((evidence.boundary_normals * outward).sum(axis=1) > np.cos(np.radians(15))).all()


def test_the_normals_of_a_hole_point_into_it():
    evidence = silhouette_evidence(disc(90.2) & ~disc(30.3))
    of_hole = radii(evidence.boundary_points) < 60
    inward = (CENTRE - evidence.boundary_points) / radii(evidence.boundary_points)[:, None]
    assert of_hole.any()
    along = (evidence.boundary_normals * inward).sum(axis=1)
    assert (along[of_hole] > 0.9).all()
    assert (along[~of_hole] < -0.9).all()


def test_boundary_points_stand_for_the_length_of_the_outline():
    evidence = silhouette_evidence(disc(90.2))
    # The chain of pixels is shorter than the circle: diagonal steps count as one.
    length = len(evidence.boundary_points) * evidence.boundary_spacing
    assert 0.85 * 2 * np.pi * 90.2 < length < 1.05 * 2 * np.pi * 90.2


def test_the_pictures_border_is_no_outline():
    mask = np.zeros((120, 100), dtype=np.bool_)
    mask[60:, 30:70] = True
    evidence = silhouette_evidence(mask)
    points = evidence.boundary_points
    assert (points[:, 1] < 119).all()
    lowest = points[points[:, 1] > 110]
    to_sides = np.minimum(np.abs(lowest[:, 0] - 30), np.abs(lowest[:, 0] - 70))
    np.testing.assert_allclose(to_sides, 0, atol=0.05)


@pytest.mark.parametrize("mask", [np.zeros((50, 60), np.bool_), np.ones((50, 60), np.bool_)])
def test_an_empty_or_a_full_mask_has_no_outline(mask: np.ndarray):
    evidence = silhouette_evidence(mask)
    assert evidence.boundary_points.shape == (0, 2)
    assert evidence.boundary_normals.shape == (0, 2)


def test_threads_too_thin_to_place_are_left_out():
    mask = np.zeros((60, 100), dtype=np.bool_)
    mask[30, 10:90] = True
    assert len(silhouette_evidence(mask).boundary_points) == 0


def test_occupied_rows_and_columns_bound_the_mask():
    mask = np.zeros((60, 100), dtype=np.bool_)
    mask[20:25, 70:90] = True
    evidence = silhouette_evidence(mask)
    np.testing.assert_array_equal(np.flatnonzero(evidence.occupied_rows), range(20, 25))
    np.testing.assert_array_equal(np.flatnonzero(evidence.occupied_columns), range(70, 90))


def test_distance_between_pixel_centres_is_interpolated():
    mask = np.zeros((60, 80), dtype=np.bool_)
    mask[:, :40] = True
    points = np.array([[40.0, 30.0], [45.25, 30.5], [30.0, 20.0]])
    np.testing.assert_allclose(
        silhouette_evidence(mask).distance_at(points), [0.0, 5.25, -10.0], atol=1e-4
    )
