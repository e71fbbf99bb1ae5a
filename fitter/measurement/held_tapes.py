"""Measurements of many bodies close to one: every tape is held to the mesh edges it bends on.

As a body changes a little, a girth's corners stay on their edges and move with them and with the
plane; that others join or leave the hull is of second order. So all derivatives by shape come from
a few dozen points of each tape, of all changed bodies at once, instead of cutting each of them.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Integer

from fitter.arrays import Vertices
from fitter.measurement._contour_kernels import STEEPEST
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
from fitter.measurement.plane_cut import BORDER_SHARE
from fitter.measurement.taking import (
    AXIS_OF,
    CENTIMETRES_PER_METRE,
    TakenBody,
    contour_of,
    girth_axis,
    girths_of,
    laid_girth,
    mean_point,
    taken_values,
)
from fitter.measurement.tape import girth_normal

Points = Float[np.ndarray, "b c 3"]


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

    def at(self, ids: Integer[np.ndarray, "..."]) -> Float[np.ndarray, "b ..."]:
        """Some vertices of all bodies."""
        return self.vertices[ids] + self.step * self.displacements[:, ids]


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class HeldTapes:
    """The tapes of one body.

    ``corners`` are the edges that a girth's corners lie on (:class:`Polyline`), None where its
    plane misses the body; ``legs`` a taut tape's steps. Both by name.
    """

    definitions: tuple[MeasurementDefinition, ...]
    taken: TakenBody
    placements: Mapping[str, float]
    corners: Mapping[str, Integer[np.ndarray, "_ 2 2"] | None]
    legs: Mapping[str, tuple[Leg, ...]]


def hold_tapes(
    definitions: Sequence[MeasurementDefinition], taken: TakenBody, placements: Mapping[str, float]
) -> HeldTapes:
    """Lay every tape on a body, and note the edges it bends on."""
    laid = {
        name: laid_girth(girth, taken, placements) for name, girth in girths_of(definitions).items()
    }
    return HeldTapes(
        definitions=tuple(definitions),
        taken=taken,
        placements=placements,
        corners={name: None if tape is None else tape.edges for name, tape in laid.items()},
        legs={
            definition.about.name: contour_of(definition, taken)
            for definition in definitions
            if isinstance(definition, Contour)
        },
    )


def held_values(held: HeldTapes, moved: MovedBodies) -> Float[np.ndarray, "k b"]:
    """Every measurement of every body, in its unit."""
    corners = {
        name: _girth_corners(girth, held, moved)
        for name, girth in girths_of(held.definitions).items()
    }
    rows = [_values(definition, held, moved, corners) for definition in held.definitions]
    again = [d for d in held.definitions if isinstance(d, Mass | BackContour)]
    if again:
        fresh = dict(zip((d.about.name for d in again), _measured(again, held, moved), strict=True))
        rows = [
            fresh.get(definition.about.name, row)
            for definition, row in zip(held.definitions, rows, strict=True)
        ]
    return np.stack(rows)


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
        columns.append(taken_values(definitions, body, held.placements))
    return np.stack(columns, axis=1)


def _values(
    definition: MeasurementDefinition,
    held: HeldTapes,
    moved: MovedBodies,
    corners: Mapping[str, Points | None],
) -> Float[np.ndarray, " b"]:
    nowhere = np.full(len(moved.displacements), np.nan)
    name = definition.about.name
    match definition:
        case Girth():
            laid = corners[name]
            metres = nowhere if laid is None else _steps(np.roll(laid, -1, axis=1) - laid)
        case Extent():
            laid = corners[definition.girth.about.name]
            metres = nowhere if laid is None else _extent(laid, definition.direction)
        case Length():
            path = np.stack([mean_point(names, moved.canonical) for names in definition.path], 1)
            metres = _steps(np.diff(path, axis=1))
        case Height():
            top, bottom = (
                mean_point(names, moved.standing) for names in (definition.point, definition.above)
            )
            metres = top[:, 1] - bottom[:, 1]
        case Contour():
            metres = _contour_lengths(definition, held.legs[name], moved)
        case Mass() | BackContour():
            metres = nowhere
    return metres * CENTIMETRES_PER_METRE


def _girth_corners(girth: Girth, held: HeldTapes, moved: MovedBodies) -> Points | None:
    """Where the plane meets the edges; at a border, where the region's share falls to a half."""
    name = girth.about.name
    edges = held.corners[name]
    if edges is None:
        return None
    start, end = girth_axis(girth, moved.canonical)
    axis = end - start
    point = start + held.placements[name] * axis
    low, high = moved.at(edges[..., 0]), moved.at(edges[..., 1])
    along = _crossing(low, high, point, girth_normal(girth, axis))
    crossings = low + along[..., None] * (high - low)
    shares = held.taken.regions[name].shares
    share = shares[edges[..., 0]] + along * (shares[edges[..., 1]] - shares[edges[..., 0]])
    at_border = (edges[:, 0] != edges[:, 1]).any(axis=-1)
    first, second = share[..., 0], share[..., 1]
    rise = np.where(at_border, second - first, 1.0)
    between = np.where(at_border, (BORDER_SHARE - first) / rise, 0.0)
    return crossings[:, :, 0] + between[..., None] * (crossings[:, :, 1] - crossings[:, :, 0])


def _contour_lengths(
    definition: Contour, legs: Sequence[Leg], moved: MovedBodies
) -> Float[np.ndarray, " b"]:
    places = [mean_point(names, moved.canonical) for names in definition.path]
    total = np.zeros(len(moved.displacements))
    for leg, side, start, end in zip(legs, definition.sides, places[:-1], places[1:], strict=True):
        total += _leg_lengths(leg, side, moved, start, end)
    return total


def _leg_lengths(
    leg: Leg,
    side: Side | None,
    moved: MovedBodies,
    start: Float[np.ndarray, "b 3"],
    end: Float[np.ndarray, "b 3"],
) -> Float[np.ndarray, " b"]:
    if side is None or not len(leg.edges):
        return np.linalg.norm(end - start, axis=1)
    frame = leg_frame(start, end, side)
    low, high = moved.at(leg.edges[:, 0]), moved.at(leg.edges[:, 1])
    along = _crossing(low, high, start, frame.normal)
    offset = low + along[..., None] * (high - low) - start[:, None]
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


def _crossing(
    low: Float[np.ndarray, "b ... 3"],
    high: Float[np.ndarray, "b ... 3"],
    point: Float[np.ndarray, "b 3"],
    normal: Float[np.ndarray, "b 3"],
) -> Float[np.ndarray, "b ..."]:
    """How far along each edge the plane crosses it."""
    at = np.einsum("bi,bi->b", point, normal).reshape(-1, *[1] * (low.ndim - 2))
    below, above = (np.einsum("b...i,bi->b...", ends, normal) - at for ends in (low, high))
    return below / (below - above)


def _extent(corners: Points, direction: Direction) -> Float[np.ndarray, " b"]:
    return np.ptp(corners[:, :, AXIS_OF[direction]], axis=1)


def _steps(differences: Float[np.ndarray, "b steps d"]) -> Float[np.ndarray, " b"]:
    """Sum of the steps' lengths."""
    return np.sqrt((differences * differences).sum(axis=2)).sum(axis=1)
