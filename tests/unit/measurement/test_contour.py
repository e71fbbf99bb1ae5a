import numpy as np
import pytest

from fitter.measurement.contour import contour_legs, joined
from fitter.measurement.definitions import Contour
from fitter.measurement.plane_cut import restricted, whole_mesh
from fitter.measurement.tape import path_length_m
from tests.unit.measurement.made_up import about
from tests.unit.measurement.solids import lathe, prism, tube

FRONT, BACK, RIGHT = (0.0, 0.0, 1.0), (0.0, 0.0, -1.0), (-1.0, 0.0, 0.0)


def tape(*sides):
    path = tuple((f"point {k}",) for k in range(len(sides) + 1))
    return Contour(about=about("tape"), path=path, sides=sides, parts=("all",))


def contour(definition, region, vertices, points):
    return joined(contour_legs(definition, region, vertices, points))


def length(definition, triangles, vertices, *points):
    laid = contour(definition, whole_mesh(triangles), vertices, [np.array(p) for p in points])
    return path_length_m(laid)


def test_a_tape_half_round_a_cylinder_is_half_its_girth_but_for_its_steep_ends():
    vertices, triangles = tube(radius=0.2, height=1.0)
    quarter = 0.2 * np.array([np.cos(np.pi / 4), 0.0, np.sin(np.pi / 4)]) + [0.0, 0.5, 0.0]
    other = quarter * [-1.0, 1.0, 1.0]
    assert length(tape(FRONT), triangles, vertices, quarter, other) == pytest.approx(
        0.2 * np.pi / 2, rel=1e-3
    )
    # Half round, it would leave both ends at a right angle; it leaves them at a slope of three:
    # along a tangent from the end, then round what is left.
    ends = [0.2, 0.5, 0.0], [-0.2, 0.5, 0.0]
    half = length(tape(FRONT), triangles, vertices, *ends)
    assert 0.9 * 0.2 * np.pi < half < 0.2 * np.pi


def test_a_tape_lies_on_the_side_that_it_is_told():
    # Seen from above: flat behind, a wedge before.
    vertices, triangles = prism([(-0.2, 0.0), (0.2, 0.0), (0.0, 0.2)], heights=[0.0, 1.0])
    ends = [-0.2, 0.5, 0.0], [0.2, 0.5, 0.0]
    assert length(tape(FRONT), triangles, vertices, *ends) == pytest.approx(0.4 * np.sqrt(2.0))
    assert length(tape(BACK), triangles, vertices, *ends) == pytest.approx(0.4)


def test_a_tape_spans_a_hollow():
    y = np.linspace(0.0, 1.0, 201)
    vertices, triangles = lathe(0.2 - 0.1 * np.sin(np.pi * y), y)
    laid = length(tape(RIGHT), triangles, vertices, [-0.2, 0.01, 0.0], [-0.2, 0.99, 0.0])
    assert laid == pytest.approx(0.98, abs=1e-4)


def test_a_tape_is_as_long_either_way_and_wherever_the_body_stands():
    y = np.linspace(0.0, 1.0, 101)
    vertices, triangles = lathe(0.1 + 0.1 * np.sin(np.pi * y), y)
    bottom, top = np.array([0.0, 0.1, 0.13]), np.array([0.02, 0.9, 0.13])
    up = length(tape(FRONT), triangles, vertices, bottom, top)
    assert length(tape(FRONT), triangles, vertices, top, bottom) == pytest.approx(up, rel=1e-12)
    move = np.array([3.0, -2.0, 1.0])
    moved = length(tape(FRONT), triangles, vertices + move, bottom + move, top + move)
    assert moved == pytest.approx(up, rel=1e-9)
    assert up > np.linalg.norm(top - bottom)


def test_a_step_without_a_side_is_straight_and_steps_join():
    vertices, triangles = tube(radius=0.2, height=1.0)
    points = [np.array([0.1, 0.2, 0.2]), np.array([-0.1, 0.2, 0.2]), np.array([-0.1, 0.8, 0.9])]
    laid = contour(tape(FRONT, None), whole_mesh(triangles), vertices, points)
    assert laid[0] == pytest.approx(points[0])
    assert laid[-2:] == pytest.approx(np.stack(points[1:]))
    assert path_length_m(laid[:-1]) >= 0.2


def test_a_tape_leaves_out_what_is_no_part_of_it():
    narrow, triangles = tube(radius=0.1, height=1.0)
    wide = narrow * [1.5, 1.0, 1.5]
    vertices = np.concatenate([narrow, wide])
    both = whole_mesh(np.concatenate([triangles, triangles + len(narrow)]))
    shares = np.concatenate([np.ones(len(narrow)), np.zeros(len(wide))])
    ends = [np.array([0.09, 0.5, 0.0436]), np.array([-0.09, 0.5, 0.0436])]
    whole, part = (
        path_length_m(contour(tape(FRONT), region, vertices, ends))
        for region in (both, restricted(both, shares))
    )
    assert part == pytest.approx(0.1 * (np.pi - 2.0 * np.arcsin(0.436)), rel=0.01)
    assert whole > part + 0.02
