"""How normals change, beside which their derivatives are tested."""

import numpy as np
from jaxtyping import Float, Integer

from fitter.arrays import Triangles, Vertices


def normal_change(
    vertices: Vertices,
    triangles: Triangles,
    chosen: Integer[np.ndarray, " k"],
    moves: Float[np.ndarray, "n m 3"],
) -> Float[np.ndarray, "k n 3"]:
    """Change of chosen unit normals per unit of each of n fields of vertex motion."""
    a, b, c = triangles.T
    u, v = vertices[b] - vertices[a], vertices[c] - vertices[a]
    sums = _around(triangles, np.cross(u, v), len(vertices))[chosen]
    raw = np.stack(
        [
            _around(
                triangles,
                np.cross(move[b] - move[a], v) + np.cross(u, move[c] - move[a]),
                len(vertices),
            )[chosen]
            for move in moves
        ],
        axis=1,
    )
    length = np.linalg.norm(sums, axis=1, keepdims=True)
    unit = sums / length
    along = np.einsum("ki,kni->kn", unit, raw)
    return (raw - along[:, :, None] * unit[:, None, :]) / length[:, :, None]


def _around(
    triangles: Triangles, values: Float[np.ndarray, "f 3"], count: int
) -> Float[np.ndarray, "m 3"]:
    """Sums of the triangles' values at their corners."""
    sums = np.zeros((count, 3))
    for corner in triangles.T:
        np.add.at(sums, corner, values)
    return sums
