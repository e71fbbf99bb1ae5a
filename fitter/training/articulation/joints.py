"""Joint centres as sparse weighted sums of the vertices around them (section 3.1)."""

from collections.abc import Mapping

import numpy as np
from jaxtyping import Float, Integer
from scipy import sparse
from scipy.optimize import nnls

from fitter.arrays import Vertices
from fitter.body.model import SparseRows
from fitter.training.articulation.parts import PART_NAMES, side_and_limb
from fitter.training.articulation.rig_drives import rest_axis

# The centre about which a part turns, as a mean of bone centres of the rig. Where a bend is spread
# over several bones, its first-order centre is the mean of their centres by share of the turn.
_SIDED: Mapping[str, Mapping[str, float]] = {
    "upper_arm": {"upperarm01": 1.0},
    "forearm": {"lowerarm01": 1.0},
    "hand": {"wrist": 1.0},
    "thigh": {"upperleg01": 1.0},
    "shin": {"lowerleg01": 1.0},
    "foot": {"foot": 1.0},
}
_MIDDLE: Mapping[str, Mapping[str, float]] = {
    "pelvis": {"upperleg01.L": 0.5, "upperleg01.R": 0.5},
    "spine": {"spine05": 1 / 3, "spine04": 1 / 3, "spine03": 1 / 3},
    "chest": {"spine03": 1 / 3, "spine02": 1 / 3, "spine01": 1 / 3},
    "neck": {"neck01": 0.5, "neck02": 0.5},
    "head": {"neck03": 1 / 3, "head": 2 / 3},
}

CANDIDATES = 200
"""Vertices a joint may be a mean of; with their mirror images at joints in the middle."""

FLATTENING = 2.0
"""Distance along the bone counts this many times: the nearest vertices then form a ring about the
joint, where the plainly nearest lie all on one side (the back, for the spine)."""

SPREAD = 1e-2
"""Ridge on the weights, metres: spreads a centre over many vertices, so that it does not hang on
two or three that happen to fit the training set. Costs 0.2 mm of the fit."""

NEGLIGIBLE_WEIGHT = 1e-4


def joint_rows_of_bones(bone_names: tuple[str, ...]) -> Float[np.ndarray, "p b"]:
    """Rows that take bone centres to the p joints."""
    rows = np.zeros((len(PART_NAMES), len(bone_names)))
    for row, part in zip(rows, PART_NAMES, strict=True):
        side, limb = side_and_limb(part)
        shares = _MIDDLE.get(part) or {
            f"{bone}.{side[:1].upper()}": share for bone, share in _SIDED[limb].items()
        }
        for bone, share in shares.items():
            row[bone_names.index(bone)] = share
    return rows


def fit_joint_regressor(
    meshes: Float[np.ndarray, "s m 3"],
    joints: Float[np.ndarray, "s p 3"],
    mirror: Integer[np.ndarray, " m"],
    mirror_joint: Integer[np.ndarray, " p"],
) -> SparseRows:
    """Non-negative least squares of each joint on the vertices around it, weights summing to one.

    The regressor is made its own mirror image, so that a symmetric body has symmetric joints.

    Parameters
    ----------
    meshes, joints
        Training bodies at rest with their true joints, metres, in one frame.
    mirror, mirror_joint
        The vertex and the joint on the other side.
    """
    mean, mean_joints = meshes.mean(axis=0), joints.mean(axis=0)
    dense = np.zeros((joints.shape[1], meshes.shape[1]))
    for joint in range(joints.shape[1]):
        chosen = ring_about(mean - mean_joints[joint], rest_axis(PART_NAMES[joint]))
        if mirror_joint[joint] == joint:
            chosen = np.unique(np.concatenate([chosen, mirror[chosen]]))
        dense[joint, chosen] = convex_weights(meshes[:, chosen], joints[:, joint])
    reflected = np.zeros_like(dense)
    reflected[:, mirror] = dense[mirror_joint]
    dense = 0.5 * (dense + reflected)
    dense[dense < NEGLIGIBLE_WEIGHT] = 0.0
    rows = sparse.csr_array(dense / dense.sum(axis=1, keepdims=True))
    return SparseRows(
        names=PART_NAMES, pointers=rows.indptr, indices=rows.indices, weights=rows.data
    )


def ring_about(offsets: Vertices, axis: Float[np.ndarray, "3"]) -> Integer[np.ndarray, " c"]:
    """The vertices nearest to a joint at the origin, lengths along its bone counted double."""
    along = offsets @ axis
    squared = np.einsum("mi,mi->m", offsets, offsets) + (FLATTENING**2 - 1.0) * along**2
    return np.argsort(squared, kind="stable")[:CANDIDATES]


def convex_weights(
    points: Float[np.ndarray, "s c 3"], joint: Float[np.ndarray, "s 3"]
) -> Float[np.ndarray, " c"]:
    """Weights w >= 0 with sum 1 that minimise Σ |Σ_c w_c x_c - joint|² + ridge |w|²."""
    subjects, candidates = points.shape[:2]
    columns = (points - joint[:, None]).transpose(0, 2, 1).reshape(-1, candidates)
    columns = columns / np.sqrt(subjects)
    # A heavy row holds the sum: all other rows are differences to the joint, so w and its multiples
    # would fit as well.
    heavy = np.full((1, candidates), 10.0)
    matrix = np.concatenate([columns, SPREAD * np.eye(candidates), heavy])
    right = np.zeros(len(matrix))
    right[-1] = 10.0
    weights, _ = nnls(matrix, right)
    return weights / weights.sum()


def joint_errors_mm(
    regressor: SparseRows,
    meshes: Float[np.ndarray, "s m 3"],
    joints: Float[np.ndarray, "s p 3"],
) -> Float[np.ndarray, " p"]:
    """Mean distance of regressed from true joints, millimetres."""
    regressed = regressed_joints(regressor, meshes)
    return 1000.0 * np.linalg.norm(regressed - joints, axis=2).mean(axis=0)


def regressed_joints(
    regressor: SparseRows, meshes: Float[np.ndarray, "s m 3"]
) -> Float[np.ndarray, "s p 3"]:
    """Joints of many meshes."""
    matrix = sparse.csr_array(
        (regressor.weights, regressor.indices, regressor.pointers),
        shape=(len(regressor.names), meshes.shape[1]),
    )
    return np.stack([matrix @ mesh for mesh in meshes])


def rest_joints_of(regressor: SparseRows, mesh: Vertices) -> Float[np.ndarray, "p 3"]:
    """Joints of one mesh."""
    return regressed_joints(regressor, mesh[None])[0]
