"""A girth as single steps of numpy: what the compiled ones are compared with."""

from collections.abc import Sequence

import numpy as np

from fitter.arrays import Vector3, Vertices
from fitter.measurement._girth_kernels import SCRAP_SHARE
from fitter.measurement.definitions import Girth
from fitter.measurement.plane_cut import (
    Plane,
    Polyline,
    Region,
    hull_indices,
    plane_section,
    surrounds,
)
from fitter.measurement.tape import girth_normal, path_length_m
from tests.unit.measurement.plain_hull import hull_of, in_plane


def plain_tape(
    girth: Girth, region: Region, vertices: Vertices, start: Vector3, end: Vector3, fraction: float
) -> Polyline | None:
    """The tape at a fraction of the axis."""
    axis = end - start
    plane = Plane(point=start + fraction * axis, normal=girth_normal(girth, axis))
    cut = _under_tape(girth, region, vertices, plane)
    if cut is None:
        return None
    corners = hull_indices(in_plane(cut.points, plane))
    return Polyline(points=cut.points[corners], edges=cut.edges[corners], closed=True)


def _under_tape(girth: Girth, region: Region, vertices: Vertices, plane: Plane) -> Polyline | None:
    """The cut that a tape goes round, as one line; None where the plane misses the region."""
    lines = plane_section(vertices, region, plane)
    if not lines:
        return None
    lines = _without_scraps(lines)
    if girth.around_axis and len(lines) > 1:
        lines = (_line_around(lines, plane),)
    if len(lines) == 1:
        return lines[0]
    return Polyline(
        points=np.concatenate([line.points for line in lines]),
        edges=np.concatenate([line.edges for line in lines]),
        closed=False,
    )


def _without_scraps(lines: Sequence[Polyline]) -> Sequence[Polyline]:
    """The lines a tape goes round.

    Where a line closes, open ones lie on a limb beyond the region's border. Above the armpits,
    where none closes, front and back are what the tape spans, and short ones are such scraps: they
    come and go as the plane moves, and a girth that took them in would jump by 6 mm.
    """
    closed = tuple(line for line in lines if line.closed)
    if closed or len(lines) == 1:
        return closed or lines
    lengths = [path_length_m(line.points) for line in lines]
    return [
        line
        for line, length in zip(lines, lengths, strict=True)
        if length > SCRAP_SHARE * max(lengths)
    ]


def _line_around(lines: Sequence[Polyline], plane: Plane) -> Polyline:
    """The line whose hull contains the plane's point, else the one whose middle is nearest."""

    def rank(line: Polyline) -> tuple[bool, float]:
        hull = hull_of(in_plane(line.points, plane))
        return (
            not surrounds(hull, np.zeros(2)),
            float(np.linalg.norm(line.points.mean(axis=0) - plane.point)),
        )

    return min(lines, key=rank)
