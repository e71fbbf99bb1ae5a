"""A part of a person as the renderer takes it."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Integer

from fitter.arrays import Normals, PerVertex, Triangles, Vertices


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class PersonMesh:
    """A part of the person; vertices in the world, metres, albedo linear.

    ``labels`` (k,) is the :class:`Label` of each vertex.
    """

    vertices: Vertices
    normals: Normals
    triangles: Triangles
    albedo: Float[np.ndarray, "k 3"]
    roughness: PerVertex
    labels: Integer[np.ndarray, " k"]
