import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial import ConvexHull
from scipy.spatial.transform import Rotation

from fitter.measurement.plane_cut import (
    Plane,
    closed_length,
    plane_section,
    restricted,
    surrounds,
    whole_mesh,
)
from tests.unit.measurement.plain_hull import hull_of, in_plane
from tests.unit.measurement.solids import prism, sphere, tube

UP = np.array([0.0, 1.0, 0.0])


def level(height):
    return Plane(point=np.array([0.0, height, 0.0]), normal=UP)


def girth(vertices, triangles, plane):
    lines = plane_section(vertices, whole_mesh(triangles), plane)
    return closed_length(hull_of(in_plane(np.concatenate([e.points for e in lines]), plane)))


def test_a_level_cut_through_a_polygonal_tube_has_the_polygons_perimeter():
    vertices, triangles = tube(radius=0.2, height=1.0, sides=64)
    exact = 64 * 2 * 0.2 * np.sin(np.pi / 64)
    assert girth(vertices, triangles, level(0.437)) == pytest.approx(exact, abs=1e-12)


def test_a_level_cut_through_a_sphere_is_a_circle_of_latitude():
    vertices, triangles = sphere(radius=0.3)
    for height in (-0.2, 0.0, 0.11):
        radius = np.sqrt(0.3**2 - height**2)
        measured = girth(vertices, triangles, level(height))
        assert measured == pytest.approx(2 * np.pi * radius, rel=2e-4)


def test_a_cut_is_one_closed_loop_whose_points_lie_in_the_plane_and_on_the_surface():
    vertices, triangles = sphere(radius=0.3)
    normal = np.array([0.6, 0.0, 0.8])
    plane = Plane(point=0.1 * normal, normal=normal)
    (line,) = plane_section(vertices, whole_mesh(triangles), plane)
    assert line.closed
    np.testing.assert_allclose((line.points - plane.point) @ normal, 0.0, atol=1e-14)
    np.testing.assert_allclose(np.linalg.norm(line.points, axis=1), 0.3, atol=2e-4)
    steps = np.linalg.norm(np.roll(line.points, -1, axis=0) - line.points, axis=1)
    assert steps.max() < 0.01, "consecutive points are neighbours on the mesh"


def test_a_cut_exactly_through_a_ring_of_vertices_is_still_one_loop():
    vertices, triangles = tube(radius=0.2, height=1.0, sides=64, rings=5)
    lines = plane_section(vertices, whole_mesh(triangles), level(0.5))
    assert [line.closed for line in lines] == [True]
    assert closed_length(lines[0].points) == pytest.approx(64 * 0.4 * np.sin(np.pi / 64))


def test_a_plane_that_misses_the_mesh_cuts_nothing():
    vertices, triangles = tube(radius=0.2, height=1.0)
    assert plane_section(vertices, whole_mesh(triangles), level(1.5)) == ()


def test_the_tape_spans_the_hollow_of_a_section_that_is_not_convex():
    star = [(0, 2), (-1, 0), (-2, 2), (-2, -1), (2, -1), (2, 2), (1, 0)]
    outline = [(x, -z) for x, z in star]
    vertices, triangles = prism(outline, heights=[0.0, 1.0])
    (line,) = plane_section(vertices, whole_mesh(triangles), level(0.5))
    assert closed_length(line.points) == pytest.approx(4 * np.sqrt(5) + 2 * 3 + 4)
    assert girth(vertices, triangles, level(0.5)) == pytest.approx(2 * 4 + 2 * 3)


def test_a_girth_does_not_change_when_body_and_plane_move_together():
    vertices, triangles = sphere(radius=0.3)
    vertices = vertices * [1.0, 1.3, 0.7]
    plane = Plane(point=np.array([0.0, 0.1, 0.0]), normal=np.array([0.36, 0.48, 0.8]))
    before = girth(vertices, triangles, plane)
    rotation = Rotation.from_rotvec([0.3, -1.1, 2.0]).as_matrix()
    shift = np.array([3.0, -2.0, 5.0])
    moved = Plane(point=rotation @ plane.point + shift, normal=rotation @ plane.normal)
    after = girth(vertices @ rotation.T + shift, triangles, moved)
    assert after == pytest.approx(before, abs=1e-12)


def test_a_restricted_region_gives_the_open_part_of_the_loop():
    vertices, triangles = tube(radius=0.2, height=1.0, sides=360)
    front = np.clip(0.5 + vertices[:, 2] / 0.1, 0.0, 1.0)
    (line,) = plane_section(vertices, restricted(whole_mesh(triangles), front), level(0.3))
    assert not line.closed
    length = np.linalg.norm(np.diff(line.points, axis=0), axis=1).sum()
    assert length == pytest.approx(np.pi * 0.2, rel=1e-4)
    np.testing.assert_allclose(line.points[[0, -1], 2], 0.0, atol=1e-4)


def test_the_border_of_a_region_cuts_across_triangles():
    vertices, triangles = tube(radius=0.2, height=1.0, sides=24)
    for border in (0.03, 0.05, 0.07):
        shares = np.clip(0.5 + (vertices[:, 2] - border) / 0.4, 0.0, 1.0)
        (line,) = plane_section(vertices, restricted(whole_mesh(triangles), shares), level(0.3))
        np.testing.assert_allclose(line.points[[0, -1], 2], border, atol=1e-12)
        assert (line.points[1:-1, 2] > border).all()


def test_a_region_that_a_plane_crosses_twice_gives_two_lines():
    vertices, triangles = tube(radius=0.2, height=1.0, sides=360)
    front_and_back = np.clip(np.abs(vertices[:, 2]) / 0.2, 0.0, 1.0)
    lines = plane_section(vertices, restricted(whole_mesh(triangles), front_and_back), level(0.3))
    assert [line.closed for line in lines] == [False, False]
    for line in lines:
        length = np.linalg.norm(np.diff(line.points, axis=0), axis=1).sum()
        assert length == pytest.approx(0.2 * np.deg2rad(120.0), rel=1e-3)


@given(seed=st.integers(0, 10_000), count=st.integers(3, 60))
def test_the_hull_agrees_with_qhull(seed, count):
    points = np.random.default_rng(seed).normal(size=(count, 2))
    hull = hull_of(points)
    assert closed_length(hull) == pytest.approx(ConvexHull(points).area, rel=1e-12)


def test_a_hull_surrounds_its_middle_and_nothing_outside():
    hull = hull_of(np.array([[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [0.0, 1.0], [1.0, 0.5]]))
    assert len(hull) == 4
    assert surrounds(hull, np.array([1.0, 0.5]))
    assert not surrounds(hull, np.array([1.0, 1.1]))
