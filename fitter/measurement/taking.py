"""Take measurements of one body, by their definitions: values, and the lines along which."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from fitter.arrays import Points3D, Triangles, Vector3, Vertices
from fitter.measurement.contour import contour
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
from fitter.measurement.plane_cut import Region, closed_length
from fitter.measurement.tape import (
    back_contour,
    back_contour_m,
    girth_corners,
    girth_placement,
    path_length_m,
)
from fitter.numerics.meshes import enclosed_volume

CENTIMETRES_PER_METRE = 100.0

_AXES = {Direction.SIDEWAYS: 0, Direction.FORWARD: 2}


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
            girth, taken.regions[name], taken.vertices, *_axis(girth, taken.canonical)
        )
        for name, girth in girths_of(definitions).items()
    }


def taken_values(
    definitions: Sequence[MeasurementDefinition], taken: TakenBody, placements: Mapping[str, float]
) -> Float[np.ndarray, " k"]:
    """Each measurement in its unit; NaN where a tape misses the body."""
    corners = {
        name: _corners(girth, taken, placements) for name, girth in girths_of(definitions).items()
    }
    return np.array([_value(definition, taken, corners) for definition in definitions])


def taken_line(
    definition: MeasurementDefinition, taken: TakenBody, placements: Mapping[str, float]
) -> Points3D:
    """Where the measurement is taken, (k, 3) on the body in the canonical pose; empty if nowhere.

    A girth is closed by repeating its first point. A caliper's line runs through the middle of what
    it spans.
    """
    points = taken.canonical
    match definition:
        case Mass():
            return np.zeros((0, 3))
        case Girth():
            corners = _corners(definition, taken, placements)
            return np.concatenate([corners, corners[:1]])
        case Extent():
            return _caliper(_corners(definition.girth, taken, placements), definition.direction)
        case Length():
            return np.stack([_point(names, points) for names in definition.path])
        case Height():
            top, bottom = (_point(names, points) for names in (definition.point, definition.above))
            return np.stack([top, [top[0], bottom[1], top[2]]])
        case Contour():
            return _contour(definition, taken)
        case BackContour():
            return back_contour(
                taken.regions[definition.about.name],
                taken.vertices,
                _point(definition.top, points),
                _point(definition.bottom, points),
            )


def _value(
    definition: MeasurementDefinition, taken: TakenBody, corners: Mapping[str, Points3D]
) -> float:
    points = taken.canonical
    match definition:
        case Mass():
            volume = enclosed_volume(taken.vertices, taken.triangles)
            return volume * definition.density_kg_per_m3
        case Girth():
            laid = corners[definition.about.name]
            metres = closed_length(laid) if len(laid) else float("nan")
        case Extent():
            laid = corners[definition.girth.about.name][:, _AXES[definition.direction]]
            metres = float(laid.max() - laid.min()) if len(laid) else float("nan")
        case Length():
            metres = path_length_m([_point(names, points) for names in definition.path])
        case Height():
            top, bottom = (
                _point(names, taken.standing) for names in (definition.point, definition.above)
            )
            metres = float(top[1] - bottom[1])
        case Contour():
            metres = path_length_m(_contour(definition, taken))
        case BackContour():
            metres = back_contour_m(
                taken.regions[definition.about.name],
                taken.vertices,
                _point(definition.top, points),
                _point(definition.bottom, points),
            )
    return metres * CENTIMETRES_PER_METRE


def _corners(girth: Girth, taken: TakenBody, placements: Mapping[str, float]) -> Points3D:
    name = girth.about.name
    return girth_corners(
        girth, taken.regions[name], taken.vertices, *_axis(girth, taken.canonical), placements[name]
    )


def _contour(definition: Contour, taken: TakenBody) -> Points3D:
    places = [_point(names, taken.canonical) for names in definition.path]
    return contour(definition, taken.regions[definition.about.name], taken.vertices, places)


def _caliper(corners: Points3D, direction: Direction) -> Float[np.ndarray, "ends 3"]:
    """From one jaw to the other, along the middle of the corners."""
    if not len(corners):
        return corners
    low, high = corners.min(axis=0), corners.max(axis=0)
    ends = np.stack([0.5 * (low + high)] * 2)
    axis = _AXES[direction]
    ends[:, axis] = low[axis], high[axis]
    return ends


def _axis(girth: Girth, points: Mapping[str, Vector3]) -> tuple[Vector3, Vector3]:
    """Where the girth's fractions 0 and 1 lie."""
    start, end = _point(girth.start, points), _point(girth.end, points)
    if girth.origin is None:
        return start, end
    axis = end - start
    shift = axis * float((_point(girth.origin, points) - start) @ axis / (axis @ axis))
    return start + shift, end + shift


def _point(names: PointNames, points: Mapping[str, Vector3]) -> Vector3:
    return sum((points[name] for name in names[1:]), start=points[names[0]]) / len(names)
