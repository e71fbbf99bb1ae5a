"""Numba kernels of the SCAPE evaluation; see :mod:`fitter.body.scape` for what they compute."""

from typing import no_type_check

import numpy as np
from numba import njit


@no_type_check
@njit(cache=True, fastmath=True)
def assemble_right_hand_side(
    shape_terms,
    shape,
    pose_terms,
    features,
    widths,
    pointers,
    vertices,
    rotations,
    result,
):
    """Sum over parts of R_p (S_i [1, β] + P_i φ_p), scattered to the vertices."""
    result[:] = 0.0
    parts = len(pointers) - 1
    n = len(shape)
    local = np.empty(3)
    for part in range(parts):
        rotation = rotations[part]
        width = widths[part]
        for incidence in range(pointers[part], pointers[part + 1]):
            for c in range(3):
                terms = shape_terms[incidence, c]
                value = float(terms[0])
                for k in range(n):
                    value += terms[k + 1] * shape[k]
                pose = pose_terms[incidence, c]
                for k in range(width):
                    value += pose[k] * features[part, k]
                local[c] = value
            vertex = vertices[incidence]
            for r in range(3):
                result[vertex, r] += (
                    rotation[r, 0] * local[0]
                    + rotation[r, 1] * local[1]
                    + rotation[r, 2] * local[2]
                )


@no_type_check
@njit(cache=True, fastmath=True)
def gather_gradient(
    shape_terms,
    shape,
    pose_terms,
    features,
    widths,
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
    parts = len(pointers) - 1
    n = len(shape)
    # Local sums: the compiler cannot know that the results do not overlap the terms.
    by_shape = np.zeros(n + 1)
    by_feature = np.zeros(features.shape[1])
    for part in range(parts):
        rotation = rotations[part]
        width = widths[part]
        by_feature[:] = 0.0
        for incidence in range(pointers[part], pointers[part + 1]):
            vertex = vertices[incidence]
            for c in range(3):
                weight = (
                    rotation[0, c] * adjoint[vertex, 0]
                    + rotation[1, c] * adjoint[vertex, 1]
                    + rotation[2, c] * adjoint[vertex, 2]
                )
                terms = shape_terms[incidence, c]
                pose = pose_terms[incidence, c]
                value = float(terms[0])
                for k in range(n):
                    value += terms[k + 1] * shape[k]
                for k in range(width):
                    value += pose[k] * features[part, k]
                for k in range(n + 1):
                    by_shape[k] += terms[k] * weight
                for k in range(width):
                    by_feature[k] += pose[k] * weight
                for r in range(3):
                    rotation_gradient[part, r, c] += adjoint[vertex, r] * value
        feature_gradient[part, :width] = by_feature[:width]
    shape_gradient[:] = by_shape[1:]


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
