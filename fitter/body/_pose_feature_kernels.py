"""Numba kernels of the pose features; see :mod:`fitter.body.pose_features`."""

from math import floor, pi, sqrt
from typing import no_type_check

import numpy as np
from numba import njit


@no_type_check
@njit(cache=True)
def half_vectors(pose, result):
    """Half of each turn, taken the short way around."""
    for j in range(len(pose)):
        x, y, z = pose[j, 0], pose[j, 1], pose[j, 2]
        angle = sqrt(x * x + y * y + z * z)
        factor = 0.5
        if angle > 0.0:
            # Half of an odd number of half turns is rounded up or down alike: both are as short.
            factor -= pi * floor(angle / (2.0 * pi) + 0.5) / angle
        for axis in range(3):
            result[j, axis] = factor * pose[j, axis]


@no_type_check
@njit(cache=True)
def turns_less_identity(turns, joints, result):
    """(R - I) of each part's joints, row by row; zero where a joint is -1."""
    for part in range(joints.shape[0]):
        for slot in range(joints.shape[1]):
            joint = joints[part, slot]
            for r in range(3):
                for c in range(3):
                    value = 0.0
                    if joint >= 0:
                        value = turns[joint, r, c] - (1.0 if r == c else 0.0)
                    result[part, 9 * slot + 3 * r + c] = value


@no_type_check
@njit(cache=True)
def turn_torques(turns, joints, feature_derivative, torques):
    """Axial vectors of (Σ of the parts' derivatives by a turn) times the turn's transpose."""
    by_turn = np.zeros_like(turns)
    for part in range(joints.shape[0]):
        for slot in range(joints.shape[1]):
            joint = joints[part, slot]
            if joint >= 0:
                for r in range(3):
                    for c in range(3):
                        by_turn[joint, r, c] += feature_derivative[part, 9 * slot + 3 * r + c]
    product = np.empty((3, 3))
    for j in range(len(turns)):
        for r in range(3):
            for c in range(3):
                product[r, c] = (
                    by_turn[j, r, 0] * turns[j, c, 0]
                    + by_turn[j, r, 1] * turns[j, c, 1]
                    + by_turn[j, r, 2] * turns[j, c, 2]
                )
        torques[j, 0] = product[2, 1] - product[1, 2]
        torques[j, 1] = product[0, 2] - product[2, 0]
        torques[j, 2] = product[1, 0] - product[0, 1]


@no_type_check
@njit(cache=True)
def add_half_turn_torques(turns, torques, result):
    """Add (I + Hᵀ)⁻¹ times the torques of the half turns, which follow the whole ones.

    With H a turn by t about the unit axis a, (I + Hᵀ)⁻¹ = ½ (I + tan(t/2) [a]×), and
    tan(t/2) a = w / (1 + trace H), w being the axial vector of H.
    """
    count = len(result)
    for j in range(count):
        x, y, z = torques[count + j, 0], torques[count + j, 1], torques[count + j, 2]
        half = turns[count + j]
        scale = 1.0 / (1.0 + half[0, 0] + half[1, 1] + half[2, 2])
        ax = (half[2, 1] - half[1, 2]) * scale
        ay = (half[0, 2] - half[2, 0]) * scale
        az = (half[1, 0] - half[0, 1]) * scale
        result[j, 0] += 0.5 * (x + ay * z - az * y)
        result[j, 1] += 0.5 * (y + az * x - ax * z)
        result[j, 2] += 0.5 * (z + ax * y - ay * x)
