"""Sums over the body's vertices that a subject's search repeats most."""

from typing import no_type_check

import numpy as np
from numba import njit


@no_type_check
@njit(cache=True)
def add_targets(base, targets, chosen, coefficients):
    """``base`` (m, 3) plus the chosen rows of ``targets`` (k, m, 3) times their coefficients."""
    body = base.copy()
    flat = body.reshape(-1)
    for target in chosen:
        coefficient = coefficients[target]
        displacement = targets[target].reshape(-1)
        for k in range(flat.size):
            flat[k] += coefficient * displacement[k]
    return body


@no_type_check
@njit(cache=True, fastmath=True)
def pulls_on_targets(pull, targets, chosen):
    """Inner products of ``pull`` (m, 3) with the chosen rows of ``targets`` (k, m, 3)."""
    found = np.empty(len(chosen))
    flat = pull.reshape(-1)
    for row, target in enumerate(chosen):
        displacement = targets[target].reshape(-1)
        total = 0.0
        for k in range(flat.size):
            total += flat[k] * displacement[k]
        found[row] = total
    return found


@no_type_check
@njit(cache=True)
def volume_and_pull(vertices, triangles):
    """Enclosed volume and its derivative by every vertex (m, 3)."""
    pull = np.zeros_like(vertices)
    volume = 0.0
    for triangle in range(len(triangles)):
        a, b, c = triangles[triangle]
        for axis in range(3):
            u, v = (axis + 1) % 3, (axis + 2) % 3
            across = vertices[b, u] * vertices[c, v] - vertices[b, v] * vertices[c, u]
            volume += vertices[a, axis] * across / 6.0
            pull[a, axis] += across / 6.0
            pull[b, axis] += (
                vertices[c, u] * vertices[a, v] - vertices[c, v] * vertices[a, u]
            ) / 6.0
            pull[c, axis] += (
                vertices[a, u] * vertices[b, v] - vertices[a, v] * vertices[b, u]
            ) / 6.0
    return volume, pull
