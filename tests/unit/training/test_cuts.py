import numpy as np
import pytest

from fitter.errors import NumericalError
from fitter.training.surveys.cuts import limb_cut, trunk_cut
from tests.unit.measurement.solids import prism, tube

UP = np.array([0.0, 1.0, 0.0])


def test_the_girth_of_a_cylinder_is_its_circumference_however_the_tape_is_tilted():
    vertices, triangles = tube(radius=0.1, height=1.0)
    middle = np.array([0.0, 0.47, 0.0])
    level = limb_cut(vertices, triangles, middle, UP)
    assert level.girth(vertices) == pytest.approx(2 * np.pi * 0.1, rel=1e-4)
    angle = 0.3
    tilted = limb_cut(vertices, triangles, middle, np.array([0.0, np.cos(angle), np.sin(angle)]))
    # An ellipse with half axes r and r / cos(angle), by Ramanujan's formula.
    a, b = 0.1, 0.1 / np.cos(angle)
    ellipse = np.pi * (3 * (a + b) - np.sqrt((3 * a + b) * (a + 3 * b)))
    assert tilted.girth(vertices) == pytest.approx(ellipse, rel=1e-4)


def test_the_tape_spans_hollows():
    outline = [(0.2, 0.2), (0.2, -0.2), (-0.2, -0.2), (-0.2, 0.2), (0.0, 0.0)]
    vertices, triangles = prism(outline, heights=[0.0, 0.5, 1.0])
    cut = limb_cut(vertices, triangles, np.array([0.05, 0.3, -0.1]), UP)
    assert cut.girth(vertices) == pytest.approx(1.6)


def test_only_the_loop_around_the_point_is_measured():
    thin, triangles = tube(radius=0.05, height=1.0)
    thick, _ = tube(radius=0.2, height=1.0)
    both = np.concatenate([thin + [0.5, 0.0, 0.0], thick])
    faces = np.concatenate([triangles, triangles + len(thin)])
    around_thin = limb_cut(both, faces, np.array([0.48, 0.33, 0.01]), UP)
    around_thick = limb_cut(both, faces, np.array([0.1, 0.33, 0.0]), UP)
    assert around_thin.girth(both) == pytest.approx(2 * np.pi * 0.05, rel=1e-3)
    assert around_thick.girth(both) == pytest.approx(2 * np.pi * 0.2, rel=1e-3)


def test_the_tape_around_the_trunk_holds_everything_that_is_cut():
    leg, triangles = tube(radius=0.1, height=1.0)
    both = np.concatenate([leg - [0.15, 0.0, 0.0], leg + [0.15, 0.0, 0.0]])
    faces = np.concatenate([triangles, triangles + len(leg)])
    cut = trunk_cut(both, faces, np.array([0.0, 0.33, 0.0]), UP)
    assert cut.girth(both) == pytest.approx(2 * np.pi * 0.1 + 2 * 0.3, rel=1e-3)


def test_the_tape_around_the_trunk_closes_over_a_part_left_out():
    vertices, triangles = tube(radius=0.1, height=1.0)
    half = triangles[(vertices[triangles, 0] < 1e-9).all(axis=1)]
    cut = trunk_cut(vertices, half, np.array([0.0, 0.33, 0.0]), UP)
    assert cut.girth(vertices) == pytest.approx(np.pi * 0.1 + 0.2, rel=1e-3)


def test_a_cut_follows_the_body_it_was_placed_on():
    vertices, triangles = tube(radius=0.1, height=1.0)
    cut = limb_cut(vertices, triangles, np.array([0.0, 0.31, 0.0]), UP)
    grown = vertices * [1.3, 2.0, 1.3]
    assert cut.girth(grown) == pytest.approx(1.3 * cut.girth(vertices))


def test_a_plane_through_vertices_still_gives_the_girth():
    vertices, triangles = tube(radius=0.1, height=1.0, rings=9)
    cut = limb_cut(vertices, triangles, np.array([0.0, 0.5, 0.0]), UP)
    assert cut.girth(vertices) == pytest.approx(2 * np.pi * 0.1, rel=1e-4)


def test_a_plane_that_misses_the_body_is_an_error():
    vertices, triangles = tube(radius=0.1, height=1.0)
    with pytest.raises(NumericalError, match="misses the body"):
        limb_cut(vertices, triangles, np.array([0.0, 2.0, 0.0]), UP)
