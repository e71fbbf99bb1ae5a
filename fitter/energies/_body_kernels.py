"""Numba kernels of the terms of the body alone: spheres that penetrate, and its stance.

A stance is nine vectors in the camera frame, metres: rows of a (9, 3) array. Derivatives are by
complex steps, f(x + ih) = f(x) + ih f'(x), exact to rounding because every feature is analytic.
"""

from math import sqrt
from typing import NamedTuple, no_type_check

import numpy as np
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


HIPS, BALANCE, ANKLES, TRUNK, MIDDLE, LEFT_THIGH, LEFT_SHIN, RIGHT_THIGH, RIGHT_SHIN = range(9)
VECTORS, FEATURES = 9, 9

_STEP = 1e-20


class Kinds(NamedTuple):
    """Every kind of stance with every camera: means (9,), precisions (k, 9) and offsets (k,)."""

    means: np.ndarray
    precisions: np.ndarray
    offsets: np.ndarray


class Weighed(NamedTuple):
    """The energy at a tilt; the features' departures and weights (9,), the shares of the kinds."""

    energy: float
    departures: np.ndarray
    weights: np.ndarray
    shares: np.ndarray


@no_type_check
@njit(cache=True)
def dot(a, b):
    """A · b without conjugation, which would end the derivative."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


@no_type_check
@njit(cache=True)
def cosine(a, b):
    """Cosine of the angle between two vectors."""
    return dot(a, b) / np.sqrt(dot(a, a) * dot(b, b))


@no_type_check
@njit(cache=True)
def features(vectors, pitch, roll):
    """Balance forward and to the left, ankles in height and forward, trunk, knees, camera."""
    up = np.empty(3, dtype=np.complex128)
    up[0] = -np.sin(roll) * np.cos(pitch)
    up[1] = -np.cos(roll) * np.cos(pitch)
    up[2] = np.sin(pitch)
    left = vectors[HIPS] - dot(vectors[HIPS], up) * up
    left = left / np.sqrt(dot(left, left))
    forward = np.empty(3, dtype=np.complex128)
    forward[0] = left[1] * up[2] - left[2] * up[1]
    forward[1] = left[2] * up[0] - left[0] * up[2]
    forward[2] = left[0] * up[1] - left[1] * up[0]
    result = np.empty(FEATURES, dtype=np.complex128)
    length = np.sqrt(dot(vectors[TRUNK], vectors[TRUNK]))
    result[0] = dot(vectors[BALANCE], forward)
    result[1] = dot(vectors[BALANCE], left)
    result[2] = dot(vectors[ANKLES], up)
    result[3] = dot(vectors[ANKLES], forward)
    result[4] = dot(vectors[TRUNK], forward) / length
    result[5] = dot(vectors[TRUNK], left) / length
    result[6] = 2.0 - cosine(vectors[LEFT_THIGH], vectors[LEFT_SHIN])
    result[6] -= cosine(vectors[RIGHT_THIGH], vectors[RIGHT_SHIN])
    result[7] = -dot(vectors[MIDDLE], up)
    result[8] = roll
    return result


@no_type_check
@njit(cache=True)
def slopes_by_vectors(vectors, tilt):
    """(9, 9, 3) derivatives of the features by the vectors."""
    slopes = np.empty((FEATURES, VECTORS, 3))
    moved = vectors.astype(np.complex128)
    for v in range(VECTORS):
        for c in range(3):
            moved[v, c] += 1j * _STEP
            slopes[:, v, c] = features(moved, complex(tilt[0]), complex(tilt[1])).imag / _STEP
            moved[v, c] = vectors[v, c]
    return slopes


@no_type_check
@njit(cache=True)
def slopes_by_tilt(vectors, tilt):
    """(9, 2) derivatives of the features by pitch and roll."""
    slopes = np.empty((FEATURES, 2))
    fixed = vectors.astype(np.complex128)
    slopes[:, 0] = features(fixed, tilt[0] + 1j * _STEP, complex(tilt[1])).imag / _STEP
    slopes[:, 1] = features(fixed, complex(tilt[0]), tilt[1] + 1j * _STEP).imag / _STEP
    return slopes


@no_type_check
@njit(cache=True)
def weigh(vectors, tilt, kinds):
    """The energy at a tilt, and how the kinds share it."""
    found = features(vectors.astype(np.complex128), complex(tilt[0]), complex(tilt[1]))
    departures = found.real - kinds.means
    costs = kinds.offsets + 0.5 * np.dot(kinds.precisions, departures * departures)
    least = costs.min()
    shares = np.exp(least - costs)
    total = shares.sum()
    shares /= total
    weights = np.dot(shares, kinds.precisions)
    return Weighed(least - np.log(total), departures, weights, shares)


@no_type_check
@njit(cache=True)
def normal_equations(vectors, tilt, weighed):
    """Normal equations of half the weighted squares of the departures, the kinds' shares held."""
    slopes = slopes_by_tilt(vectors, tilt)
    matrix, gradient = np.zeros((2, 2)), np.zeros(2)
    for i in range(FEATURES):
        for r in range(2):
            gradient[r] += weighed.weights[i] * slopes[i, r] * weighed.departures[i]
            for c in range(2):
                matrix[r, c] += weighed.weights[i] * slopes[i, r] * slopes[i, c]
    return matrix, gradient
