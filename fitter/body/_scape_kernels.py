"""Numba kernels of the SCAPE evaluation; see :mod:`fitter.body.scape` for what they compute."""

from typing import no_type_check

import numpy as np
from numba import njit, uint32


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
