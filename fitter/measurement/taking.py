"""Take measurements of one body, by their definitions: values, and the lines along which."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from fitter.arrays import Points3D, Triangles, Vector3, Vertices
from fitter.measurement.contour import Leg, contour_legs, joined
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
    PointNames,
)
from fitter.measurement.plane_cut import Polyline, Region, closed_length
from fitter.measurement.tape import (
    back_contour,
    back_contour_m,
    girth_placement,
    girth_tape,
    path_length_m,
)
from fitter.numerics.meshes import enclosed_volume
from fitter.vocabulary.measurements import CENTIMETRES_PER_METRE

AXIS_OF = {Direction.SIDEWAYS: 0, Direction.FORWARD: 2}


Place = Float[np.ndarray, "*b 3"]
"""A point of one body, or of many."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class TakenBody:
    """One shape's vertices and points, ready for the tape; body frame, metres.

    Attributes
    ----------
    vertices, triangles
        Of the body in the canonical pose.
    regions
        Where the tape of each measurement with parts may run, by its name.
    canonical, standing
        Its points in both poses, by name.
    """

    vertices: Vertices
    triangles: Triangles
    regions: Mapping[str, Region]
    canonical: Mapping[str, Vector3]
    standing: Mapping[str, Vector3]


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class LaidTapes:
    """The tapes of one body, by the names of what they measure.

    ``girths`` are None where their plane misses the body; ``legs`` are the steps of taut tapes,
    and ``backs`` tapes down the back, which may be empty.
    """

    girths: Mapping[str, Polyline | None]
    legs: Mapping[str, tuple[Leg, ...]]
    backs: Mapping[str, Polyline]


def girths_of(definitions: Sequence[MeasurementDefinition]) -> Mapping[str, Girth]:
    """The girths that must be laid for the definitions, by name: their own and extents'."""
    found: dict[str, Girth] = {}
    for definition in definitions:
        if isinstance(definition, Girth | Extent):
            girth = definition if isinstance(definition, Girth) else definition.girth
            found[girth.about.name] = girth
    return found


def girth_placements(
    definitions: Sequence[MeasurementDefinition], taken: TakenBody
) -> Mapping[str, float]:
    """The fraction along its axis at which each girth is taken, by name."""
    return {
        name: girth_placement(
            girth, taken.regions[name], taken.vertices, *girth_axis(girth, taken.canonical)
        )
        for name, girth in girths_of(definitions).items()
    }


def lay_tapes(
    definitions: Sequence[MeasurementDefinition], taken: TakenBody, placements: Mapping[str, float]
) -> LaidTapes:
    """Lay every tape that the definitions need."""
    return LaidTapes(
        girths={
            name: laid_girth(girth, taken, placements)
            for name, girth in girths_of(definitions).items()
        },
        legs={
            definition.about.name: contour_of(definition, taken)
            for definition in definitions
            if isinstance(definition, Contour)
        },
        backs={
            definition.about.name: _back_of(definition, taken)
            for definition in definitions
            if isinstance(definition, BackContour)
        },
    )


def taken_values(
    definitions: Sequence[MeasurementDefinition], taken: TakenBody, laid: LaidTapes
) -> Float[np.ndarray, " k"]:
    """Each measurement in its unit; NaN where a tape misses the body."""
    return np.array([_value(definition, taken, laid) for definition in definitions])


def taken_line(
    definition: MeasurementDefinition, taken: TakenBody, placements: Mapping[str, float]
) -> Points3D:
    """Line of the measurement, (k, 3) on the body in the canonical pose; empty if there is none.

    A girth is closed by repeating its first point. A caliper's line runs through the middle of what
    it spans.
    """
    points = taken.canonical
    match definition:
        case Mass():
            return np.zeros((0, 3))
        case Girth():
            tape = laid_girth(definition, taken, placements)
            return np.zeros((0, 3)) if tape is None else tape.points[np.r_[: len(tape.points), 0]]
        case Extent():
            tape = laid_girth(definition.girth, taken, placements)
            return np.zeros((0, 3)) if tape is None else _caliper(tape.points, definition.direction)
        case Length():
            return np.stack([mean_point(names, points) for names in definition.path])
        case Height():
            top, bottom = (
                mean_point(names, points) for names in (definition.point, definition.above)
            )
            return np.stack([top, [top[0], bottom[1], top[2]]])
        case Contour():
            return joined(contour_of(definition, taken))
        case BackContour():
            return _back_of(definition, taken).points


def _value(definition: MeasurementDefinition, taken: TakenBody, laid: LaidTapes) -> float:
    points = taken.canonical
    match definition:
        case Mass():
            volume = enclosed_volume(taken.vertices, taken.triangles)
            return volume * definition.density_kg_per_m3
        case Girth():
            tape = laid.girths[definition.about.name]
            metres = float("nan") if tape is None else closed_length(tape.points)
        case Extent():
            tape = laid.girths[definition.girth.about.name]
            axis = AXIS_OF[definition.direction]
            metres = float("nan") if tape is None else float(np.ptp(tape.points[:, axis]))
        case Length():
            metres = path_length_m([mean_point(names, points) for names in definition.path])
        case Height():
            top, bottom = (
                mean_point(names, taken.standing) for names in (definition.point, definition.above)
            )
            metres = float(top[1] - bottom[1])
        case Contour():
            metres = sum(path_length_m(leg.points) for leg in laid.legs[definition.about.name])
        case BackContour():
            metres = back_contour_m(laid.backs[definition.about.name])
    return metres * CENTIMETRES_PER_METRE


def laid_girth(girth: Girth, taken: TakenBody, placements: Mapping[str, float]) -> Polyline | None:
    """The tape of a girth; None where its plane misses the body."""
    name = girth.about.name
    axis = girth_axis(girth, taken.canonical)
    return girth_tape(girth, taken.regions[name], taken.vertices, *axis, placements[name])


def contour_of(definition: Contour, taken: TakenBody) -> tuple[Leg, ...]:
    """The steps of a taut tape."""
    places = [mean_point(names, taken.canonical) for names in definition.path]
    return contour_legs(definition, taken.regions[definition.about.name], taken.vertices, places)


def _back_of(definition: BackContour, taken: TakenBody) -> Polyline:
    """The tape down the back; empty where its plane misses the body."""
    return back_contour(
        taken.regions[definition.about.name],
        taken.vertices,
        mean_point(definition.top, taken.canonical),
        mean_point(definition.bottom, taken.canonical),
    )


def _caliper(corners: Points3D, direction: Direction) -> Float[np.ndarray, "ends 3"]:
    """From one jaw to the other, along the middle of the corners."""
    low, high = corners.min(axis=0), corners.max(axis=0)
    ends = np.stack([0.5 * (low + high)] * 2)
    axis = AXIS_OF[direction]
    ends[:, axis] = low[axis], high[axis]
    return ends


def girth_axis(girth: Girth, points: Mapping[str, Place]) -> tuple[Place, Place]:
    """Ends of a girth's axis, fractions 0 and 1, of one body or of many at once."""
    start, end = mean_point(girth.start, points), mean_point(girth.end, points)
    if girth.origin is None:
        return start, end
    axis = end - start
    offset = mean_point(girth.origin, points) - start
    share = (offset * axis).sum(axis=-1) / (axis * axis).sum(axis=-1)
    shift = axis * share[..., None]
    return start + shift, end + shift


def mean_point(names: PointNames, points: Mapping[str, Place]) -> Place:
    """The mean of points, of one body or of many at once."""
    return sum((points[name] for name in names[1:]), start=points[names[0]]) / len(names)
