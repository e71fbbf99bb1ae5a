"""Numba kernels of the kinematic chain; see :mod:`fitter.body.skeleton`."""

from typing import no_type_check

from numba import njit


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
