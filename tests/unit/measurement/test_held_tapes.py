"""Tapes held to mesh edges beside tapes laid afresh."""

from dataclasses import replace

import numpy as np
import pytest

from fitter.measurement._contour_kernels import crossings
from fitter.measurement.definitions import (
    BackContour,
    Contour,
    Direction,
    Extent,
    Girth,
    Length,
    Mass,
    Orientation,
    Selection,
)
from fitter.measurement.held_tapes import MovedBodies, held_values, hold_tapes
from fitter.measurement.plane_cut import restricted, whole_mesh
from fitter.measurement.taking import TakenBody, girth_placements, lay_tapes, taken_values
from tests.unit.measurement.made_up import about
from tests.unit.measurement.solids import tube

GIRTH = Girth(
    about=about("girth"),
    start=("bottom",),
    end=("top",),
    origin=None,
    fractions=(0.4, 0.4),
    selection=Selection.LARGEST,
    orientation=Orientation.ACROSS_AXIS,
    parts=("all",),
    around_axis=True,
)
LEVEL = replace(GIRTH, about=about("level"), orientation=Orientation.LEVEL)
DEFINITIONS = (
    GIRTH,
    LEVEL,
    Extent(about=about("breadth"), girth=LEVEL, direction=Direction.SIDEWAYS),
    Extent(about=about("depth"), girth=LEVEL, direction=Direction.FORWARD),
    Length(about=about("length"), path=(("bottom",), ("top",), ("side",))),
    Contour(
        about=about("tape"),
        path=(("side",), ("front",), ("top",)),
        sides=((1.0, 0.0, 1.0), None),
        parts=("all",),
    ),
    BackContour(about=about("back"), top=("top",), bottom=("bottom",), parts=("all",)),
    Mass(about=about("weight"), density_kg_per_m3=1.0),
)
POINTS = {
    "bottom": np.array([0.0, 0.1, 0.0]),
    "top": np.array([0.02, 0.9, 0.03]),
    # Before the skin: where a tape begins on it and skin moves, bends come and go at that end.
    "side": np.array([0.22, 0.4, 0.01]),
    "front": np.array([0.01, 0.5, 0.23]),
}
STEP = 1e-4


@pytest.fixture
def cylinder():
    return tube(radius=0.2, height=1.0, sides=48, rings=7)


def taken(vertices, region, points):
    names = [d.about.name for d in DEFINITIONS]
    return TakenBody(
        vertices=vertices,
        triangles=region.triangles,
        regions=dict.fromkeys(names, region),
        canonical=points,
        standing=points,
    )


def freshly(body, placements):
    """The measurements of one body whose tapes are laid on it alone."""
    return taken_values(DEFINITIONS, body, lay_tapes(DEFINITIONS, body, placements))


def both_ways(vertices, region, displacements, shifts):
    """Derivatives by held tapes, and by laying them afresh: (k, b) each, metres a unit."""
    body = taken(vertices, region, POINTS)
    placements = girth_placements(DEFINITIONS, body)
    before = freshly(body, placements)
    points = {name: point + STEP * shifts for name, point in POINTS.items()}
    moved = MovedBodies(
        vertices=vertices,
        displacements=displacements,
        step=STEP,
        canonical=points,
        standing=points,
    )
    held = held_values(hold_tapes(DEFINITIONS, body, placements), moved)
    fresh = [
        freshly(
            taken(
                vertices + STEP * displacement,
                region,
                {name: point[index] for name, point in points.items()},
            ),
            placements,
        )
        for index, displacement in enumerate(displacements)
    ]
    return (held - before[:, None]) / STEP, (np.stack(fresh, axis=1) - before[:, None]) / STEP


def test_tapes_of_changed_bodies_are_as_long_as_laid_afresh(cylinder):
    vertices, triangles = cylinder
    rng = np.random.default_rng(3)
    bends = rng.normal(size=(4, 3, 3)), rng.normal(size=(4, 1, 3))
    displacements = vertices @ bends[0] + bends[1]
    held, fresh = both_ways(vertices, whole_mesh(triangles), displacements, bends[1][:, 0])
    assert np.isfinite(held).all()
    np.testing.assert_allclose(held[:-1], fresh[:-1], atol=2e-6)
    # A volume is held to first order.
    np.testing.assert_allclose(held[-1], fresh[-1], rtol=1e-2)


def test_a_tape_that_ends_at_a_border_moves_with_it(cylinder):
    """The right half of the cylinder alone: two corners lie where the share falls to a half."""
    vertices, triangles = cylinder
    shares = np.clip(0.5 - 2.0 * (vertices[:, 0] + 0.3 * vertices[:, 1] - 0.21), 0.0, 1.0)
    region = restricted(whole_mesh(triangles), shares)
    rng = np.random.default_rng(4)
    bends = rng.normal(size=(3, 3, 3)), np.zeros((3, 1, 3))
    held, fresh = both_ways(vertices, region, vertices @ bends[0], bends[1][:, 0])
    np.testing.assert_allclose(held[:4], fresh[:4], atol=2e-6)
    tape = hold_tapes(
        (LEVEL,),
        taken(vertices, region, POINTS),
        {"level": 0.4},
    ).laid.girths["level"]
    assert tape is not None
    assert (tape.edges[:, 0] != tape.edges[:, 1]).any(axis=1).sum() == 2


def test_a_growing_cylinder_gains_two_pi_of_girth_and_two_of_breadth(cylinder):
    vertices, triangles = tube(radius=0.2, height=1.0)
    outward = vertices * [1.0, 0.0, 1.0] / 0.2
    held, _ = both_ways(vertices, whole_mesh(triangles), outward[None], np.zeros((1, 3)))
    gains = dict(zip((d.about.name for d in DEFINITIONS), held[:, 0] / 100.0, strict=True))
    assert gains["level"] == pytest.approx(2.0 * np.pi, rel=1e-3)
    assert gains["breadth"] == pytest.approx(2.0, rel=1e-3)
    assert gains["length"] == 0.0


def test_a_tape_that_misses_the_body_has_no_length(cylinder):
    vertices, triangles = cylinder
    body = taken(vertices, whole_mesh(triangles), POINTS)
    moved = MovedBodies(
        vertices=vertices,
        displacements=np.zeros((2, len(vertices), 3)),
        step=STEP,
        canonical={name: np.stack([point] * 2) for name, point in POINTS.items()},
        standing={},
    )
    definitions = (replace(GIRTH, fractions=(1.5, 1.5)),)
    values = held_values(hold_tapes(definitions, body, {"girth": 1.5}), moved)
    assert np.isnan(values).all()


def test_compiled_crossings_are_those_of_whole_arrays(cylinder):
    vertices, _ = cylinder
    rng = np.random.default_rng(5)
    displacements = rng.normal(size=(3, len(vertices), 3))
    edges = rng.permutation(len(vertices))[:20].reshape(-1, 2)
    point = np.array([0.0, 0.5, 0.0]) + 0.1 * rng.normal(size=(3, 3))
    normal = rng.normal(size=(3, 3))
    along, points, beyond = crossings(vertices, displacements, 0.01, edges, point, normal)
    moved = vertices + 0.01 * displacements
    low, high = moved[:, edges[:, 0]], moved[:, edges[:, 1]]
    below, above = (np.einsum("bci,bi->bc", ends - point[:, None], normal) for ends in (low, high))
    shares = below / (below - above)
    np.testing.assert_allclose(along, shares, rtol=1e-9)
    np.testing.assert_allclose(points, low + shares[..., None] * (high - low), rtol=1e-9)
    lengths = np.linalg.norm(high - low, axis=2)
    assert beyond == pytest.approx((np.maximum(-shares, shares - 1.0) * lengths).max())
