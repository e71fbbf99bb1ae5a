"""Lay a tape taut over the skin from point to point. Metres throughout."""

from collections.abc import Sequence

import numpy as np

from fitter.arrays import Points3D, Vector3, Vertices
from fitter.measurement._contour_kernels import taut_chain
from fitter.measurement.definitions import Contour
from fitter.measurement.plane_cut import Region


def contour(
    definition: Contour, region: Region, vertices: Vertices, points: Sequence[Vector3]
) -> Points3D:
    """The tape along the definition's path, whose points have these places.

    (k, 3) in the frame of the vertices. Where a step of the path has a side, the tape lies in the
    plane through both ends that holds that direction, on the outer side of the convex hull of the
    skin between them: it touches what stands out and spans hollows. Elsewhere it is straight.
    """
    legs = [
        np.stack([start, end]) if side is None else _taut(region, vertices, start, end, side)
        for start, end, side in zip(points[:-1], points[1:], definition.sides, strict=True)
    ]
    return np.concatenate([legs[0], *(leg[1:] for leg in legs[1:])])


def _taut(
    region: Region, vertices: Vertices, start: Vector3, end: Vector3, side: Sequence[float]
) -> Points3D:
    length = float(np.linalg.norm(end - start))
    along = (end - start) / length
    outward = np.asarray(side) - along * float(along @ np.asarray(side))
    outward /= np.linalg.norm(outward)
    chain = taut_chain(
        np.ascontiguousarray(vertices),
        region.shares,
        region.triangles,
        region.members,
        region.vertices,
        start,
        along,
        outward,
        np.cross(along, outward),
        length,
    )
    return start + chain @ np.stack([along, outward])
