"""Numba kernels of the penetration proxy."""

from math import sqrt
from typing import no_type_check

from numba import njit


@no_type_check
@njit(cache=True, fastmath=True)
def ring_spheres(vertices, pointers, indices, weights, fillings, centres, radii):
    """Centres: weighted means of the rings; radii: mean distances from there times the fillings."""
    for s in range(len(pointers) - 1):
        x = y = z = 0.0
        for k in range(pointers[s], pointers[s + 1]):
            v = indices[k]
            x += weights[k] * vertices[v, 0]
            y += weights[k] * vertices[v, 1]
            z += weights[k] * vertices[v, 2]
        centres[s, 0], centres[s, 1], centres[s, 2] = x, y, z
        mean = 0.0
        for k in range(pointers[s], pointers[s + 1]):
            v = indices[k]
            dx = vertices[v, 0] - x
            dy = vertices[v, 1] - y
            dz = vertices[v, 2] - z
            mean += weights[k] * sqrt(dx * dx + dy * dy + dz * dz)
        radii[s] = fillings[s] * mean


@no_type_check
@njit(cache=True, fastmath=True)
def squared_overlaps(centres, radii, pairs):
    """Sum of squared overlaps; most pairs are apart, which their squared distance tells."""
    total = 0.0
    for q in range(len(pairs)):
        a = pairs[q, 0]
        b = pairs[q, 1]
        dx = centres[a, 0] - centres[b, 0]
        dy = centres[a, 1] - centres[b, 1]
        dz = centres[a, 2] - centres[b, 2]
        reach = radii[a] + radii[b]
        squared = dx * dx + dy * dy + dz * dz
        if squared < reach * reach:
            overlap = reach - sqrt(squared)
            total += overlap * overlap
    return total


@no_type_check
@njit(cache=True, fastmath=True)
def pair_overlaps(centres, radii, pairs, result):
    """Sum of radii minus distance for each pair."""
    for q in range(len(pairs)):
        a = pairs[q, 0]
        b = pairs[q, 1]
        dx = centres[a, 0] - centres[b, 0]
        dy = centres[a, 1] - centres[b, 1]
        dz = centres[a, 2] - centres[b, 2]
        result[q] = radii[a] + radii[b] - sqrt(dx * dx + dy * dy + dz * dz)
