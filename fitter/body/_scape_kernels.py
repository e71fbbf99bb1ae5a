"""Numba kernels of the body: its skeleton, the features of its pose, its surface."""

from math import floor, pi, sqrt
from typing import no_type_check

import numpy as np
from numba import njit, uint32


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


@no_type_check
@njit(cache=True, fastmath=True)
def weighted_sums(pointers, indices, weights, vertices, result):
    """Rows of ``result``: the sums of vertices of each CSR-like row."""
    for row in range(len(pointers) - 1):
        x = y = z = 0.0
        for k in range(pointers[row], pointers[row + 1]):
            v = indices[k]
            x += weights[k] * vertices[v, 0]
            y += weights[k] * vertices[v, 1]
            z += weights[k] * vertices[v, 2]
        result[row, 0], result[row, 1], result[row, 2] = x, y, z


@no_type_check
@njit(cache=True, fastmath=True)
def chain_rotations(local, parents, result):
    """R_parent times the local rotation, parents first."""
    for part in range(len(parents)):
        parent = parents[part]
        for r in range(3):
            for c in range(3):
                if parent < 0:
                    result[part, r, c] = local[part, r, c]
                else:
                    result[part, r, c] = (
                        result[parent, r, 0] * local[part, 0, c]
                        + result[parent, r, 1] * local[part, 1, c]
                        + result[parent, r, 2] * local[part, 2, c]
                    )


@no_type_check
@njit(cache=True, fastmath=True)
def chain_joints(rest, rotations, parents, result):
    """Joints (b, p, 3) of b chains at rest, with every bone turned by its parent's rotation."""
    for b in range(rest.shape[0]):
        for part in range(len(parents)):
            parent = parents[part]
            for r in range(3):
                result[b, part, r] = 0.0
            if parent < 0:
                continue
            for r in range(3):
                value = result[b, parent, r]
                for c in range(3):
                    bone = rest[b, part, c] - rest[b, parent, c]
                    value += rotations[parent, r, c] * bone
                result[b, part, r] = value


@no_type_check
@njit(cache=True, fastmath=True)
def assemble_right_hand_side(terms, widths, shape, features, pointers, vertices, rotations, result):
    """Sum over parts of R_p (S_i [1, β] + P_i φ_p), scattered to the vertices.

    ``terms`` holds rows [S_i, P_i], as wide as each part's ``widths``, one after the other.
    """
    result[:] = 0.0
    n = len(shape)
    factors = np.ones(1 + n + features.shape[1])
    factors[1 : n + 1] = shape
    local = np.empty(3)
    entry = uint32(0)
    for part in range(len(pointers) - 1):
        rotation = rotations[part]
        width = uint32(widths[part])
        factors[n + 1 :] = features[part]
        for incidence in range(pointers[part], pointers[part + 1]):
            for c in range(3):
                value = 0.0
                for k in range(width):
                    value += terms[entry + k] * factors[k]
                entry += width
                local[c] = value
            vertex = uint32(vertices[incidence])
            for r in range(3):
                result[vertex, r] += (
                    rotation[r, 0] * local[0]
                    + rotation[r, 1] * local[1]
                    + rotation[r, 2] * local[2]
                )


@no_type_check
@njit(cache=True, fastmath=True)
def gather_gradient(
    terms,
    widths,
    shape,
    features,
    pointers,
    vertices,
    rotations,
    adjoint,
    shape_gradient,
    feature_gradient,
    rotation_gradient,
):
    """Reverse of :func:`assemble_right_hand_side` for a given adjoint of the right-hand side."""
    shape_gradient[:] = 0.0
    feature_gradient[:] = 0.0
    rotation_gradient[:] = 0.0
    n = len(shape)
    factors = np.ones(1 + n + features.shape[1], dtype=np.float32)
    factors[1 : n + 1] = shape
    # A local sum: the compiler cannot know that the results do not overlap the terms.
    sums = np.empty(len(factors), dtype=np.float32)
    entry = uint32(0)
    for part in range(len(pointers) - 1):
        rotation = rotations[part]
        width = uint32(widths[part])
        factors[n + 1 :] = features[part]
        sums[:] = 0.0
        for incidence in range(pointers[part], pointers[part + 1]):
            vertex = uint32(vertices[incidence])
            for c in range(3):
                weight = np.float32(
                    rotation[0, c] * adjoint[vertex, 0]
                    + rotation[1, c] * adjoint[vertex, 1]
                    + rotation[2, c] * adjoint[vertex, 2]
                )
                value = np.float32(0.0)
                for k in range(width):
                    term = terms[entry + k]
                    value += term * factors[k]
                    sums[k] += term * weight
                entry += width
                for r in range(3):
                    rotation_gradient[part, r, c] += adjoint[vertex, r] * value
        for k in range(n):
            shape_gradient[k] += sums[k + 1]
        for k in range(n + 1, width):
            feature_gradient[part, k - n - 1] = sums[k]


@no_type_check
@njit(cache=True, fastmath=True)
def place(vertices, root_weights, axes, translation, result):
    """(x - root) * axes + translation; ``root_weights`` take the root joint from the vertices."""
    root = np.zeros(3)
    for v in range(len(vertices)):
        weight = root_weights[v]
        if weight != 0.0:
            for c in range(3):
                root[c] += weight * vertices[v, c]
    for c in range(3):
        root[c] = translation[c] - axes[c] * root[c]
    for v in range(len(vertices)):
        for c in range(3):
            result[v, c] = axes[c] * vertices[v, c] + root[c]


@no_type_check
@njit(cache=True, fastmath=True)
def place_reverse(derivative, root_weights, axes, result, by_translation):
    """Reverse of :func:`place`: by vertices, and by translation."""
    by_translation[:] = 0.0
    for v in range(len(derivative)):
        for c in range(3):
            by_translation[c] += derivative[v, c]
    for v in range(len(derivative)):
        weight = root_weights[v]
        for c in range(3):
            result[v, c] = axes[c] * (derivative[v, c] - weight * by_translation[c])
