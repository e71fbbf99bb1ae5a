"""What drives the pose-dependent term: (R_joint - I) of whole and of half turns.

A part lists its joints by number. Number j of p stands for the joint's whole turn R_j, number p + j
for half of it, H_j with H_j² = R_j and an angle of less than half a turn: a shoulder blade follows
a raised arm by a share of its angle, which the sine and cosine of the whole angle do not give.
"""

import numpy as np
from jaxtyping import Float, Integer

from fitter.arrays import Pose, Rotations
from fitter.body import _pose_feature_kernels as kernels
from fitter.numerics.rotations import rotation_matrices

FeatureJoints = Integer[np.ndarray, "p q"]


def half_turns(pose: Pose) -> Pose:
    """Rotation vectors of half the turns, each taken the short way around."""
    halves = np.empty_like(pose)
    kernels.half_vectors(pose, halves)
    return halves


def pose_features(pose: Pose, joints: FeatureJoints) -> Float[np.ndarray, "p nine_q"]:
    """(R - I) of each part's joints, joint by joint and row by row, zero where unused (-1)."""
    features = np.empty((len(joints), 9 * joints.shape[1]))
    kernels.turns_less_identity(_turns(pose), joints, features)
    return features


def pose_derivative(
    pose: Pose, joints: FeatureJoints, feature_derivative: Float[np.ndarray, "p nine_q"]
) -> Pose:
    """Derivative of a scalar by increments δ of each joint, applied as exp(δ) exp(pose).

    From (exp(η) H)² = exp(δ) H² follows (I + H) η = δ for half turns.

    Parameters
    ----------
    pose, joints
        As in :func:`pose_features`.
    feature_derivative
        Derivative of the scalar by the features.
    """
    count = len(pose)
    turns = _turns(pose)
    torques = np.empty((len(turns), 3))
    kernels.turn_torques(turns, joints, np.ascontiguousarray(feature_derivative), torques)
    result = torques[:count].copy()
    kernels.add_half_turn_torques(turns, torques, result)
    return result


def axial_vectors(matrices: Rotations) -> Float[np.ndarray, "p 3"]:
    """Axial vectors w of matrices A: <A, [v]×> = w · v for every v."""
    return np.stack(
        [
            matrices[:, 2, 1] - matrices[:, 1, 2],
            matrices[:, 0, 2] - matrices[:, 2, 0],
            matrices[:, 1, 0] - matrices[:, 0, 1],
        ],
        axis=1,
    )


def _turns(pose: Pose) -> Float[np.ndarray, "2*p 3 3"]:
    """(2 p, 3, 3) whole turns, then half turns."""
    return rotation_matrices(np.concatenate([pose, half_turns(pose)]))
