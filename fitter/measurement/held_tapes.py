"""Measurements of many bodies close to one: every tape is held to the mesh edges it bends on.

As a body changes a little, a girth's corners stay on their edges and move with them and with the
plane; that others join or leave the hull is of second order. So all derivatives by shape come from
a few dozen points of each tape, of all changed bodies at once, instead of cutting each of them.

Where an edge lies nearly in the plane its corner may leave it, however small the change. Such tapes
are laid anew on every body: what the corner would do beyond its edge is nothing that skin does.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Integer

from fitter.arrays import Vertices
from fitter.measurement._contour_kernels import STEEPEST, crossings
from fitter.measurement.contour import Leg, Side, leg_frame
from fitter.measurement.definitions import (
    BackContour,
    Contour,
    Direction,
    Extent,
    Girth,
    Height,
    Length,
    Mass,
    MeasurementDefinition,
)
from fitter.measurement.plane_cut import BORDER_SHARE, Polyline
from fitter.measurement.taking import (
    AXIS_OF,
    LaidTapes,
    TakenBody,
    girth_axis,
    girths_of,
    lay_tapes,
    mean_point,
    taken_values,
)
from fitter.measurement.tape import SIDEWAYS, UNKNOWN, girth_normal
from fitter.numerics.meshes import enclosed_volume, volume_gradient
from fitter.vocabulary.measurements import CENTIMETRES_PER_METRE

LEAVING_M = 1e-6
"""A corner this far beyond its edge has left it: a fiftieth of what a step of the derivatives moves
skin by. The vertex of a landmark that lies in its own plane is nearer."""

Points = Float[np.ndarray, "b c 3"]


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class _Crossings:
    """Crossings of planes and edges, and whether any has left its edge."""

    along: Float[np.ndarray, "b ..."]
    points: Float[np.ndarray, "b ... 3"]
    have_left: bool


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class MovedBodies:
    """b bodies close to one; body frame, metres.

    Attributes
    ----------
    vertices
        (m, 3) of that one.
    displacements, step
        How each differs from it: by so many times its displacement.
    canonical, standing
        Their points in both poses, by name.
    """

    vertices: Vertices
    displacements: Float[np.ndarray, "b m 3"]
    step: float
    canonical: Mapping[str, Float[np.ndarray, "b 3"]]
    standing: Mapping[str, Float[np.ndarray, "b 3"]]


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class HeldTapes:
    """The tapes of one body.

    ``laid`` tells the edges that corners lie on (:class:`Polyline`).
    """

    definitions: tuple[MeasurementDefinition, ...]
    taken: TakenBody
    placements: Mapping[str, float]
    laid: LaidTapes


def hold_tapes(
    definitions: Sequence[MeasurementDefinition], taken: TakenBody, placements: Mapping[str, float]
) -> HeldTapes:
    """Lay every tape on a body, and hold it to the edges it bends on."""
    return HeldTapes(
        definitions=tuple(definitions),
        taken=taken,
        placements=placements,
        laid=lay_tapes(definitions, taken, placements),
    )


def held_values(held: HeldTapes, moved: MovedBodies) -> Float[np.ndarray, "k b"]:
    """Every measurement of every body, in its unit."""
    corners = {
        name: _girth_corners(girth, held, moved)
        for name, girth in girths_of(held.definitions).items()
    }
    rows = [_values(definition, held, moved, corners) for definition in held.definitions]
    again = [d for d, row in zip(held.definitions, rows, strict=True) if row is None]
    anew = iter(_measured(again, held, moved)) if again else iter(())
    return np.stack([next(anew) if row is None else row for row in rows])


def _measured(
    definitions: Sequence[MeasurementDefinition], held: HeldTapes, moved: MovedBodies
) -> Float[np.ndarray, "k b"]:
    """Measurements taken of one body after the other."""
    columns: list[np.ndarray] = []
    for index, displacement in enumerate(moved.displacements):
        body = TakenBody(
            vertices=moved.vertices + moved.step * displacement,
            triangles=held.taken.triangles,
            regions=held.taken.regions,
            canonical={name: points[index] for name, points in moved.canonical.items()},
            standing={},
        )
        columns.append(
            taken_values(definitions, body, lay_tapes(definitions, body, held.placements))
        )
    return np.stack(columns, axis=1)


def _values(
    definition: MeasurementDefinition,
    held: HeldTapes,
    moved: MovedBodies,
    corners: Mapping[str, Points | None],
) -> Float[np.ndarray, " b"] | None:
    """One measurement of every body; None if it must be taken of one after the other."""
    name = definition.about.name
    match definition:
        case Girth():
            laid = corners[name]
            metres = None if laid is None else _steps(np.roll(laid, -1, axis=1) - laid)
        case Extent():
            laid = corners[definition.girth.about.name]
            metres = None if laid is None else _extent(laid, definition.direction)
        case Length():
            path = np.stack([mean_point(names, moved.canonical) for names in definition.path], 1)
            metres = _steps(np.diff(path, axis=1))
        case Height():
            top, bottom = (
                mean_point(names, moved.standing) for names in (definition.point, definition.above)
            )
            metres = top[:, 1] - bottom[:, 1]
        case Contour():
            metres = _contour_lengths(definition, held.laid.legs[name], moved)
        case BackContour():
            metres = _back_lengths(definition, held.laid.backs[name], moved)
        case Mass():
            return definition.density_kg_per_m3 * _volumes(held, moved)
    return None if metres is None else metres * CENTIMETRES_PER_METRE


def _girth_corners(girth: Girth, held: HeldTapes, moved: MovedBodies) -> Points | None:
    """Corners where the plane meets the edges, or where a region's share falls to a half.

    None where it no longer meets them.
    """
    name = girth.about.name
    tape = held.laid.girths[name]
    if tape is None:
        return None
    edges = tape.edges
    start, end = girth_axis(girth, moved.canonical)
    axis = end - start
    point = start + held.placements[name] * axis
    crossed = _crossings(moved, edges, point, girth_normal(girth, axis))
    if crossed.have_left:
        return None
    crossings, along = crossed.points, crossed.along
    shares = held.taken.regions[name].shares
    share = shares[edges[..., 0]] + along * (shares[edges[..., 1]] - shares[edges[..., 0]])
    at_border = (edges[:, 0] != edges[:, 1]).any(axis=-1)
    first, second = share[..., 0], share[..., 1]
    rise = np.where(at_border, second - first, 1.0)
    between = np.where(at_border, (BORDER_SHARE - first) / rise, 0.0)
    return crossings[:, :, 0] + between[..., None] * (crossings[:, :, 1] - crossings[:, :, 0])


def _contour_lengths(
    definition: Contour, legs: Sequence[Leg], moved: MovedBodies
) -> Float[np.ndarray, " b"] | None:
    places = [mean_point(names, moved.canonical) for names in definition.path]
    lengths = [
        _leg_lengths(leg, side, moved, start, end)
        for leg, side, start, end in zip(
            legs, definition.sides, places[:-1], places[1:], strict=True
        )
    ]
    found = [length for length in lengths if length is not None]
    return np.sum(found, axis=0) if len(found) == len(lengths) else None


def _leg_lengths(
    leg: Leg,
    side: Side | None,
    moved: MovedBodies,
    start: Float[np.ndarray, "b 3"],
    end: Float[np.ndarray, "b 3"],
) -> Float[np.ndarray, " b"] | None:
    if side is None or not len(leg.edges):
        return np.linalg.norm(end - start, axis=1)
    frame = leg_frame(start, end, side)
    crossed = _crossings(moved, leg.edges, start, frame.normal)
    if crossed.have_left:
        return None
    offset = crossed.points - start[:, None]
    u = np.einsum("bci,bi->bc", offset, frame.along)
    v = np.einsum("bci,bi->bc", offset, frame.outward)
    # A bend that has left the tape, beyond an end or under the straight line, lies on that line.
    u = np.clip(u, 0.0, frame.length)
    v = np.clip(v, 0.0, STEEPEST * np.minimum(u, frame.length - u))
    none = np.zeros_like(frame.length)
    chain = np.stack(
        [np.concatenate([none, u, frame.length], 1), np.concatenate([none, v, none], 1)], axis=2
    )
    return _steps(np.diff(chain, axis=1))


def _back_lengths(
    definition: BackContour, back: Polyline, moved: MovedBodies
) -> Float[np.ndarray, " b"] | None:
    """Along the bends of a taut back; its ends lie between two edges, at both points' heights."""
    bends = back.edges[1:-1]
    if (back.edges == UNKNOWN).any() or (bends[:, 0] != bends[:, 1]).any():
        return None
    top, bottom = (
        mean_point(names, moved.canonical) for names in (definition.top, definition.bottom)
    )
    normal = np.broadcast_to(SIDEWAYS, top.shape)
    crossed = _crossings(moved, back.edges, top, normal)
    if crossed.have_left:
        return None
    chain = crossed.points[:, :, 0]
    for end, height in ((0, top[:, 1]), (-1, bottom[:, 1])):
        first, second = crossed.points[:, end, 0], crossed.points[:, end, 1]
        along = (height - first[:, 1]) / (second[:, 1] - first[:, 1])
        chain[:, end] = first + along[:, None] * (second - first)
    return _steps(np.diff(chain, axis=1))


def _volumes(held: HeldTapes, moved: MovedBodies) -> Float[np.ndarray, " b"]:
    """To first order, cubic metres: a step of the derivatives adds a ten-millionth beyond it."""
    vertices, triangles = held.taken.vertices, held.taken.triangles
    slopes = volume_gradient(vertices, triangles)
    changes = moved.displacements.reshape(len(moved.displacements), -1) @ slopes.reshape(-1)
    return enclosed_volume(vertices, triangles) + moved.step * changes


def _crossings(
    moved: MovedBodies,
    edges: Integer[np.ndarray, "... 2"],
    point: Float[np.ndarray, "b 3"],
    normal: Float[np.ndarray, "b 3"],
) -> _Crossings:
    along, points, beyond = crossings(
        moved.vertices,
        moved.displacements,
        moved.step,
        edges.reshape(-1, 2),
        point,
        normal,
    )
    return _Crossings(
        along=along.reshape(-1, *edges.shape[:-1]),
        points=points.reshape(-1, *edges.shape[:-1], 3),
        have_left=beyond > LEAVING_M,
    )


def _extent(corners: Points, direction: Direction) -> Float[np.ndarray, " b"]:
    return np.ptp(corners[:, :, AXIS_OF[direction]], axis=1)


def _steps(differences: Float[np.ndarray, "b steps d"]) -> Float[np.ndarray, " b"]:
    """Sum of the steps' lengths."""
    return np.sqrt((differences * differences).sum(axis=2)).sum(axis=1)
