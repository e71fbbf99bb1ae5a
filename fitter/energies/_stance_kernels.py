"""Numba kernels of the tilt; see :mod:`fitter.energies.stance` for what they compute.

A stance is nine vectors in the camera frame, metres: rows of a (9, 3) array. Derivatives are by
complex steps, f(x + ih) = f(x) + ih f'(x), exact to rounding because every feature is analytic.
"""

from typing import no_type_check

import numpy as np
from numba import njit

HIPS, BALANCE, ANKLES, TRUNK, MIDDLE, LEFT_THIGH, LEFT_SHIN, RIGHT_THIGH, RIGHT_SHIN = range(9)
VECTORS, FEATURES = 9, 9

_STEP = 1e-20
_ITERATIONS = 30
_SETTLED = 1e-6
_LONGEST_TURN = 0.3


@no_type_check
@njit(cache=True)
def dot(a, b):
    """A · b without conjugation, which would end the derivative."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


@no_type_check
@njit(cache=True)
def cosine(a, b):
    """Of the angle between two vectors."""
    return dot(a, b) / np.sqrt(dot(a, a) * dot(b, b))


@no_type_check
@njit(cache=True)
def fill_features(vectors, pitch, roll, result):
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


@no_type_check
@njit(cache=True)
def fill_slopes(vectors, tilt, by_vectors, by_tilt):
    """Derivatives of the features: (9, 9, 3) by the vectors, (9, 2) by pitch and roll."""
    features = np.empty(FEATURES, dtype=np.complex128)
    moved = vectors.astype(np.complex128)
    for v in range(VECTORS):
        for c in range(3):
            moved[v, c] += 1j * _STEP
            fill_features(moved, complex(tilt[0]), complex(tilt[1]), features)
            moved[v, c] = vectors[v, c]
            by_vectors[:, v, c] = features.imag / _STEP
    fill_features(moved, tilt[0] + 1j * _STEP, complex(tilt[1]), features)
    by_tilt[:, 0] = features.imag / _STEP
    fill_features(moved, complex(tilt[0]), tilt[1] + 1j * _STEP, features)
    by_tilt[:, 1] = features.imag / _STEP


@no_type_check
@njit(cache=True)
def weigh(vectors, tilt, means, precisions, offsets, departures, weights, shares):
    """Energy at a tilt; fills departures from the means, weights (9,) and shares of the kinds."""
    features = np.empty(FEATURES, dtype=np.complex128)
    fill_features(vectors.astype(np.complex128), complex(tilt[0]), complex(tilt[1]), features)
    kinds = len(precisions)
    for i in range(FEATURES):
        departures[i] = features[i].real - means[i]
    least = np.inf
    for k in range(kinds):
        cost = offsets[k]
        for i in range(FEATURES):
            cost += 0.5 * precisions[k, i] * departures[i] ** 2
        shares[k] = cost
        least = min(least, cost)
    total = 0.0
    for k in range(kinds):
        shares[k] = np.exp(least - shares[k])
        total += shares[k]
    weights[:] = 0.0
    for k in range(kinds):
        shares[k] /= total
        for i in range(FEATURES):
            weights[i] += shares[k] * precisions[k, i]
    return least - np.log(total)


@no_type_check
@njit(cache=True)
def descend(vectors, tilt, means, precisions, offsets):
    """Most probable tilt from the one given, which is changed; returns its energy.

    Damped Gauss-Newton with the shares of each step held: expectation and maximisation.
    """
    kinds = len(precisions)
    departures, weights, shares = np.empty(FEATURES), np.empty(FEATURES), np.empty(kinds)
    by_vectors, by_tilt = np.empty((FEATURES, VECTORS, 3)), np.empty((FEATURES, 2))
    energy = weigh(vectors, tilt, means, precisions, offsets, departures, weights, shares)
    damping = 1e-3
    reached = np.empty(2)
    for _ in range(_ITERATIONS):
        fill_slopes(vectors, tilt, by_vectors, by_tilt)
        a, b, c, x, y = 0.0, 0.0, 0.0, 0.0, 0.0
        for i in range(FEATURES):
            a += weights[i] * by_tilt[i, 0] ** 2
            b += weights[i] * by_tilt[i, 0] * by_tilt[i, 1]
            c += weights[i] * by_tilt[i, 1] ** 2
            x += weights[i] * by_tilt[i, 0] * departures[i]
            y += weights[i] * by_tilt[i, 1] * departures[i]
        moved = False
        while damping < 1e4:
            first, second = a * (1.0 + damping), c * (1.0 + damping)
            determinant = first * second - b * b
            reached[0] = -(second * x - b * y) / determinant
            reached[1] = -(first * y - b * x) / determinant
            size = max(abs(reached[0]), abs(reached[1]))
            reached *= min(1.0, _LONGEST_TURN / max(size, 1e-12))
            reached += tilt
            lower = weigh(vectors, reached, means, precisions, offsets, departures, weights, shares)
            if lower <= energy:
                moved = True
                break
            damping *= 10.0
        if not moved:
            break
        damping = max(damping * 0.2, 1e-9)
        size = max(abs(reached[0] - tilt[0]), abs(reached[1] - tilt[1]))
        tilt[:] = reached
        energy = lower
        if size < _SETTLED:
            break
    return energy
