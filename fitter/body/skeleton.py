"""Joints and the kinematic chain."""

import numpy as np
from jaxtyping import Float, Integer

from fitter.arrays import Pose, Rotations, Vertices
from fitter.body._skeleton_kernels import chain_joints, chain_rotations, weighted_sums
from fitter.body.model import SparseRows
from fitter.numerics.rotations import rotation_matrices


def regress(rows: SparseRows, vertices: Vertices) -> Float[np.ndarray, "r 3"]:
    """Weighted sums of vertices, one point per row, in the frame of the vertices."""
    result = np.empty((len(rows.pointers) - 1, 3))
    weighted_sums(rows.pointers, rows.indices, rows.weights, np.ascontiguousarray(vertices), result)
    return result


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
    chain_rotations(local, part_parent, result)
    return result


def posed_joints(
    rest_joints: Float[np.ndarray, "... p 3"],
    rotations: Rotations,
    part_parent: Integer[np.ndarray, " p"],
) -> Float[np.ndarray, "... p 3"]:
    """Joint positions of the rigid chain, body frame, metres, root joint at the origin."""
    chains = np.ascontiguousarray(rest_joints).reshape(-1, len(part_parent), 3)
    result = np.empty_like(chains)
    chain_joints(chains, rotations, part_parent, result)
    return result.reshape(rest_joints.shape)


def descendants(part_parent: Integer[np.ndarray, " p"]) -> np.ndarray:
    """(p, p) bool: entry [j, q] says that part q moves when joint j turns (q = j included)."""
    count = len(part_parent)
    result = np.eye(count, dtype=bool)
    for part in range(count):
        if part_parent[part] >= 0:
            result[:, part] |= result[:, part_parent[part]]
    return result
