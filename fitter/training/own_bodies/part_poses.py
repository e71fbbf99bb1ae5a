"""The pose of a scan from the same subject at rest: how far each part has turned.

Registered meshes make this a closed form. Each part's turn is the rotation that takes its skin at
rest nearest to its skin in the scan (Kabsch 1976), and what remains is the pose-dependent
deformation E. Near joints skin follows neither part, so vertices count by how much they follow
this part alone, and those left far away count ever less.
"""

import numpy as np
from jaxtyping import Float

from fitter.arrays import PerVertex, Pose, Vertices
from fitter.training.named_poses import relative_pose
from fitter.training.part_tree import PART_NAMES
from fitter.training.parts import Parts

SCALE_M = 0.01
"""Of the robust weight: skin that lies this far from a rigid motion counts a quarter."""

TURNS = 10
"""How often vertices are weighed anew."""

SOLENESS = 4.0
"""Power of a vertex's skinning weight: skin that two parts share says little about either."""


def solved_pose(rest: Vertices, scan: Vertices, parts: Parts, areas: PerVertex) -> Pose:
    """Rotation vectors of all parts relative to their parents; the root's is the body's own turn.

    Parameters
    ----------
    rest, scan
        The same subject at rest and in the pose, body frame, any translation.
    parts
        Which parts each vertex follows.
    areas
        (m,) of the vertices.
    """
    turned = np.stack(
        [
            _rotation(rest, scan, areas * _following(parts, part) ** SOLENESS)
            for part in range(len(PART_NAMES))
        ]
    )
    return relative_pose(turned)


def best_rotation(
    start: Float[np.ndarray, "k 3"], end: Float[np.ndarray, "k 3"], weights: Float[np.ndarray, " k"]
) -> Float[np.ndarray, "3 3"]:
    """R that minimises Σ w |R (start - mean) - (end - mean)|² (Kabsch)."""
    share = weights / weights.sum()
    first, second = start - share @ start, end - share @ end
    u, _, vt = np.linalg.svd((share[:, None] * second).T @ first)
    u[:, 2] *= np.sign(np.linalg.det(u @ vt))
    return u @ vt


def _rotation(rest: Vertices, scan: Vertices, weights: PerVertex) -> Float[np.ndarray, "3 3"]:
    used = weights > 1e-6 * weights.max()
    start, end, weights = rest[used], scan[used], weights[used]
    robust = np.ones_like(weights)
    rotation = best_rotation(start, end, weights)
    for _ in range(TURNS):
        left = end - start @ rotation.T
        left -= np.average(left, axis=0, weights=weights * robust)
        robust = 1.0 / (1.0 + np.einsum("ki,ki->k", left, left) / SCALE_M**2) ** 2
        rotation = best_rotation(start, end, weights * robust)
    return rotation


def _following(parts: Parts, part: int) -> PerVertex:
    return np.where(parts.skinning_parts == part, parts.skinning_weights, 0.0).sum(axis=1)
