"""Numba kernels of blended landmarks; see :mod:`fitter.pose_init.landmark_rig`.

Sizes: p parts, k landmarks, j turning joints, n = 3 j (+ 3) columns; parents come before children.
"""

from typing import NamedTuple, no_type_check

import numpy as np
from numba import njit


class Rig(NamedTuple):
    """The arrays of a :class:`~fitter.pose_init.landmark_rig.LandmarkRig` that move landmarks."""

    parents: np.ndarray
    rest_joints: np.ndarray
    weights: np.ndarray
    arms: np.ndarray


class Posed(NamedTuple):
    """One pose.

    ``rotations`` (p, 3, 3) and ``joints`` (p, 3), body frame axes, root joint at the origin;
    ``shares`` (k, p, 3), the terms whose sum over parts is a landmark, alike, with their weights;
    ``points`` (k, 3), camera frame, metres.
    """

    rotations: np.ndarray
    joints: np.ndarray
    shares: np.ndarray
    points: np.ndarray


@no_type_check
@njit(cache=True)
def pose_chain(rig, local, rotations, joints):
    """R_parent times each local rotation, and every bone turned by its parent's rotation."""
    for part in range(len(rig.parents)):
        parent = rig.parents[part]
        if parent < 0:
            rotations[part] = local[part]
            joints[part] = 0.0
            continue
        for r in range(3):
            joint = joints[parent, r]
            for c in range(3):
                value = 0.0
                for i in range(3):
                    value += rotations[parent, r, i] * local[part, i, c]
                rotations[part, r, c] = value
                bone = rig.rest_joints[part, c] - rig.rest_joints[parent, c]
                joint += rotations[parent, r, c] * bone
            joints[part, r] = joint


@no_type_check
@njit(cache=True)
def pose_rig(rig, local, translation):
    """Landmarks of the pose with these local rotations (p, 3, 3) and this root position."""
    k, p = rig.weights.shape
    rotations, joints = np.empty((p, 3, 3)), np.empty((p, 3))
    shares, points = np.zeros((k, p, 3)), np.empty((k, 3))
    pose_chain(rig, local, rotations, joints)
    for landmark in range(k):
        for r in range(3):
            total = 0.0
            for part in range(p):
                weight = rig.weights[landmark, part]
                if weight != 0.0:
                    share = weight * joints[part, r]
                    for c in range(3):
                        share += rotations[part, r, c] * rig.arms[landmark, part, c]
                    shares[landmark, part, r] = share
                    total += share
            # From body to camera axes: y and z change their signs.
            points[landmark, r] = (total if r == 0 else -total) + translation[r]
    return Posed(rotations, joints, shares, points)


@no_type_check
@njit(cache=True)
def add_children(rig, values):
    """To each part's values (k, p, c) add those of all parts that turn with it."""
    for part in range(len(rig.parents) - 1, 0, -1):
        parent = rig.parents[part]
        if parent >= 0:
            for landmark in range(len(values)):
                for c in range(values.shape[2]):
                    values[landmark, parent, c] += values[landmark, part, c]


@no_type_check
@njit(cache=True)
def landmark_moves(rig, posed, turning, moving):
    """Derivative of camera-frame points by the columns, (k, 3, n).

    The columns are increments δ of the turning joints, applied as exp(δ) exp(pose), and, if it is
    moving, the root's position. The axes of an increment are those of the parent part, and a turn
    about one moves a landmark by axis × (what of it follows the joint, from the joint on).
    """
    (k, p), j = rig.weights.shape, len(turning)
    following, weights = posed.shares.copy(), rig.weights.copy().reshape(k, p, 1)
    add_children(rig, following)
    add_children(rig, weights)
    moves = np.zeros((k, 3, 3 * j + (3 if moving else 0)))
    for index in range(j):
        joint = turning[index]
        parent = rig.parents[joint]
        axes = posed.rotations[parent] if parent >= 0 else np.eye(3)
        for landmark in range(k):
            weight = weights[landmark, joint, 0]
            if weight != 0.0:
                x = following[landmark, joint, 0] - weight * posed.joints[joint, 0]
                y = following[landmark, joint, 1] - weight * posed.joints[joint, 1]
                z = following[landmark, joint, 2] - weight * posed.joints[joint, 2]
                for a in range(3):
                    column = 3 * index + a
                    moves[landmark, 0, column] = axes[1, a] * z - axes[2, a] * y
                    moves[landmark, 1, column] = -(axes[2, a] * x - axes[0, a] * z)
                    moves[landmark, 2, column] = -(axes[0, a] * y - axes[1, a] * x)
    if moving:
        for r in range(3):
            moves[:, r, 3 * j + r] = 1.0
    return moves
