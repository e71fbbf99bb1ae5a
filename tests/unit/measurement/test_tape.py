import numpy as np
import pytest

from fitter.measurement.definitions import Girth, Orientation, Selection
from fitter.measurement.plane_cut import closed_length, restricted, whole_mesh
from fitter.measurement.tape import (
    back_contour,
    back_contour_m,
    girth_at_m,
    girth_placement,
    girth_tape,
    path_length_m,
)
from tests.unit.measurement.made_up import about
from tests.unit.measurement.plain_tape import plain_tape
from tests.unit.measurement.solids import lathe, prism, tube

BOTTOM, TOP = np.zeros(3), np.array([0.0, 1.0, 0.0])


def girth(*, fractions=(0.0, 1.0), selection=Selection.LARGEST, around_axis=False, across=False):
    return Girth(
        about=about("girth"),
        start=("a",),
        end=("b",),
        origin=None,
        fractions=fractions,
        selection=selection,
        orientation=Orientation.ACROSS_AXIS if across else Orientation.LEVEL,
        parts=("all",),
        around_axis=around_axis,
    )


def vase():
    """Radius 0.2 + 0.05 sin(2 pi y): widest at 0.25, narrowest at 0.75."""
    y = np.linspace(0.0, 1.0, 201)
    return lathe(0.2 + 0.05 * np.sin(2 * np.pi * y), y)


@pytest.mark.parametrize(
    ("selection", "place", "radius"),
    [(Selection.LARGEST, 0.25, 0.25), (Selection.SMALLEST, 0.75, 0.15)],
)
def test_the_tape_finds_the_largest_and_the_smallest_girth(selection, place, radius):
    vertices, triangles = vase()
    region, definition = whole_mesh(triangles), girth(selection=selection)
    found = girth_placement(definition, region, vertices, BOTTOM, TOP)
    assert found == pytest.approx(place, abs=0.01)
    measured = girth_at_m(definition, region, vertices, BOTTOM, TOP, found)
    assert measured == pytest.approx(2 * np.pi * radius, rel=3e-4)


def test_the_search_stays_within_its_range():
    vertices, triangles = vase()
    definition = girth(fractions=(0.3, 0.6))
    place = girth_placement(definition, whole_mesh(triangles), vertices, BOTTOM, TOP)
    assert place == 0.3


def test_a_tape_across_a_slanting_axis_measures_the_limb_not_the_slant():
    vertices, triangles = tube(radius=0.1, height=1.0)
    tilt = np.deg2rad(30.0)
    rotation = np.array(
        [[np.cos(tilt), -np.sin(tilt), 0.0], [np.sin(tilt), np.cos(tilt), 0.0], [0.0, 0.0, 1.0]]
    )
    region, end = whole_mesh(triangles), rotation @ TOP
    slanting = vertices @ rotation.T
    across = girth_at_m(girth(across=True), region, slanting, BOTTOM, end, 0.5)
    level = girth_at_m(girth(), region, slanting, BOTTOM, end, 0.5)
    assert across == pytest.approx(0.2 * np.pi, rel=1e-4)
    assert level > 1.05 * across


def test_a_tape_around_one_leg_does_not_take_in_the_other():
    left, triangles = tube(radius=0.1, height=1.0)
    right = left + [0.5, 0.0, 0.0]
    vertices = np.concatenate([left, right])
    region = whole_mesh(np.concatenate([triangles, triangles + len(left)]))
    one = girth_at_m(girth(around_axis=True), region, vertices, BOTTOM, TOP, 0.5)
    both = girth_at_m(girth(), region, vertices, BOTTOM, TOP, 0.5)
    assert one == pytest.approx(0.2 * np.pi, rel=1e-4)
    assert both == pytest.approx(0.2 * np.pi + 1.0, rel=1e-4)


def test_a_tape_that_meets_nothing_measures_not_a_number():
    vertices, triangles = tube(radius=0.1, height=1.0)
    assert np.isnan(girth_at_m(girth(), whole_mesh(triangles), vertices, BOTTOM, TOP, 1.5))


def test_a_path_is_as_long_as_its_straight_steps():
    points = [np.zeros(3), np.array([3.0, 4.0, 0.0]), np.array([3.0, 4.0, 12.0])]
    assert path_length_m(points) == pytest.approx(17.0)


def test_the_back_tape_spans_a_hollow_back_and_ignores_the_belly():
    # Side view (z forward, y up) as a prism along x: a notch of depth 0.1 in a straight back.
    side_view = [(0.0, 0.0), (0.5, 0.3), (0.0, 1.0), (-0.1, 1.0), (0.0, 0.5), (-0.1, 0.0)]
    across, triangles = prism(side_view, heights=[-0.2, 0.2])
    vertices = np.stack([across[:, 1], across[:, 2], across[:, 0]], axis=1)
    top, bottom = np.array([0.0, 0.9, 0.0]), np.array([0.0, 0.2, 0.5])
    measured = back_contour_m(back_contour(whole_mesh(triangles), vertices, top, bottom))
    # On the notch's flanks the back lies at z = -0.06 at the bottom and -0.08 at the top.
    assert measured == pytest.approx(np.hypot(0.7, 0.02), abs=1e-12)


def test_the_back_tape_follows_a_round_back():
    y = np.linspace(-0.299, 0.299, 400)
    vertices, triangles = lathe(np.sqrt(0.3**2 - y**2), y)
    top, bottom = np.array([0.0, 0.15, -0.2]), np.array([0.0, -0.15, 0.2])
    measured = back_contour_m(back_contour(whole_mesh(triangles), vertices, top, bottom))
    assert measured == pytest.approx(0.3 * 2 * np.arcsin(0.5), rel=1e-3)


def test_a_tapes_corners_lie_in_its_plane_and_are_as_far_around_as_is_measured():
    vertices, triangles = vase()
    region, definition = whole_mesh(triangles), girth()
    corners = girth_tape(definition, region, vertices, BOTTOM, TOP, 0.25).points
    assert corners[:, 1] == pytest.approx(0.25)
    measured = girth_at_m(definition, region, vertices, BOTTOM, TOP, 0.25)
    assert path_length_m(np.concatenate([corners, corners[:1]])) == pytest.approx(
        measured, rel=1e-12
    )


def test_a_tape_that_meets_nothing_has_no_line():
    vertices, triangles = vase()
    region = whole_mesh(triangles)
    assert girth_tape(girth(), region, vertices, BOTTOM, TOP, 3.0) is None
    aside = np.array([5.0, 0.9, 0.0])
    missed = back_contour(region, vertices, aside, aside - [0.0, 0.5, 0.0])
    assert len(missed.points) == 0
    assert np.isnan(back_contour_m(missed))


@pytest.mark.parametrize("around_axis", [False, True])
@pytest.mark.parametrize("across", [False, True])
def test_a_compiled_tape_is_the_one_of_single_steps(around_axis, across):
    """On two bodies side by side, cut by a border that leaves scraps: every branch is taken."""
    vertices, triangles = vase()
    vertices = np.concatenate([vertices, vertices * [0.4, 1.0, 0.4] + [0.6, 0.0, 0.0]])
    triangles = np.concatenate([triangles, triangles + len(vertices) // 2])
    rng = np.random.default_rng(2)
    for shift in (-5.0, 0.0, 0.1, 0.3):
        shares = np.clip(0.5 + shift - 2.0 * np.cos(9.0 * vertices[:, 0]), 0.0, 1.0)
        region = restricted(whole_mesh(triangles), shares if shift > -5.0 else np.ones_like(shares))
        definition = girth(around_axis=around_axis, across=across)
        end = TOP + [0.05, 0.0, 0.02]
        for fraction in rng.uniform(0.05, 0.95, size=12):
            plain = plain_tape(definition, region, vertices, BOTTOM, end, fraction)
            tape = girth_tape(definition, region, vertices, BOTTOM, end, fraction)
            assert (plain is None) == (tape is None)
            if plain is not None and tape is not None:
                # Corners in a line may be left out or not, by rounding.
                assert closed_length(tape.points) == pytest.approx(
                    closed_length(plain.points), rel=1e-12
                )
                length = girth_at_m(definition, region, vertices, BOTTOM, end, fraction)
                assert length == pytest.approx(closed_length(plain.points), rel=1e-12)
