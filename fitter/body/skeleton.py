"""Joints and the kinematic chain."""

import numpy as np
from jaxtyping import Float, Integer

from fitter.arrays import Pose, Rotations, Vertices
from fitter.body.model import SparseRows
from fitter.numerics.rotations import rotation_matrices


def regress(rows: SparseRows, vertices: Vertices) -> Float[np.ndarray, "r 3"]:
    """Weighted sums of vertices, one point per row, in the frame of the vertices."""
    return np.add.reduceat(
        rows.weights[:, None] * vertices[rows.indices], rows.pointers[:-1], axis=0
    )


def dense_rows(rows: SparseRows, vertex_count: int) -> Float[np.ndarray, "r m"]:
    """The rows as a dense matrix, for precomputing products with bases."""
    dense = np.zeros((len(rows.pointers) - 1, vertex_count))
    row = np.repeat(np.arange(len(dense)), np.diff(rows.pointers))
    np.add.at(dense, (row, rows.indices), rows.weights)
    return dense


def global_rotations(pose: Pose, part_parent: Integer[np.ndarray, " p"]) -> Rotations:
    """Rotation of every part from rest to pose, in the body frame: R_parent exp(pose)."""
    local = rotation_matrices(pose)
    result = np.empty_like(local)
    for part, parent in enumerate(part_parent):
        result[part] = local[part] if parent < 0 else result[parent] @ local[part]
    return result


def posed_joints(
    rest_joints: Float[np.ndarray, "... p 3"],
    rotations: Rotations,
    part_parent: Integer[np.ndarray, " p"],
) -> Float[np.ndarray, "... p 3"]:
    """Joint positions of the rigid chain, body frame, metres, root joint at the origin."""
    result = np.zeros_like(rest_joints)
    for part, parent in enumerate(part_parent):
        if parent >= 0:
            bone = rest_joints[..., part, :] - rest_joints[..., parent, :]
            result[..., part, :] = result[..., parent, :] + bone @ rotations[parent].T
    return result


def descendants(part_parent: Integer[np.ndarray, " p"]) -> np.ndarray:
    """(p, p) bool: entry [j, q] says that part q moves when joint j turns (q = j included)."""
    count = len(part_parent)
    result = np.eye(count, dtype=bool)
    for part in range(count):
        if part_parent[part] >= 0:
            result[:, part] |= result[:, part_parent[part]]
    return result
