"""Points of a plane, and their hull."""

import numpy as np
from jaxtyping import Float

from fitter.arrays import Points2D, Points3D
from fitter.measurement._section_kernels import flatten
from fitter.measurement.plane_cut import Plane, hull_indices


def in_plane(points: Points3D, plane: Plane) -> Points2D:
    """Coordinates of points along two orthonormal directions of the plane."""
    return flatten(np.ascontiguousarray(points), plane.point, plane.normal)


def hull_of(points: Points2D) -> Float[np.ndarray, "corners 2"]:
    """Corners of the convex hull, counter-clockwise."""
    return points[hull_indices(points)]
