"""Numba kernels of the silhouette energy and its rows."""

from math import sqrt
from typing import no_type_check

import numpy as np
from numba import njit


@no_type_check
@njit(cache=True, error_model="numpy")
def bounding_box(points):
    """Smallest and largest column and row of continuous pixels."""
    left = top = np.inf
    right = bottom = -np.inf
    for i in range(len(points)):
        left, right = min(left, points[i, 0]), max(right, points[i, 0])
        top, bottom = min(top, points[i, 1]), max(bottom, points[i, 1])
    return left, right, top, bottom


@no_type_check
@njit(cache=True, fastmath=True)
def robust_mismatch(model, image, to_image, confidence, scale, floor, reach):
    """Sum over unmatched pixels of confidence times ρ'(d), d the distance to the other region.

    ``model`` holds face ids. Beyond ``scale`` a pixel costs at least ``floor``, and beyond
    ``reach`` exactly that: the model is not searched for any farther.
    """
    runs, counts = _runs(model)
    total = 0.0
    inverse = 1.0 / (scale * scale)
    height, width = model.shape
    for i in range(height):
        for j in range(width):
            covered = model[i, j] >= 0
            if covered == image[i, j]:
                continue
            d = to_image[i, j] if covered else _distance_to(runs, counts, i, j, reach)
            damping = 1.0 + d * d * inverse
            cost = d / (damping * damping)
            if d > scale and cost < floor:
                cost = floor
            total += cost * confidence[i, j]
    return total


@no_type_check
@njit(cache=True)
def _runs(model):
    """First and last covered column of every run of each row, and how many runs it has."""
    height, width = model.shape
    runs = np.empty((height, width // 2 + 1, 2), dtype=np.int32)
    counts = np.zeros(height, dtype=np.int32)
    for i in range(height):
        inside = False
        for j in range(width):
            covered = model[i, j] >= 0
            if covered and not inside:
                runs[i, counts[i], 0] = j
            if inside and not covered:
                runs[i, counts[i], 1] = j - 1
                counts[i] += 1
            inside = covered
        if inside:
            runs[i, counts[i], 1] = width - 1
            counts[i] += 1
    return runs, counts


@no_type_check
@njit(cache=True)
def _distance_to(runs, counts, row, column, reach):
    """Distance from a pixel to the nearest covered one, between centres; at most ``reach``."""
    least = reach * reach
    away = 0
    while away * away < least:
        for i in (row - away, row + away):
            if 0 <= i < len(counts):
                for k in range(counts[i]):
                    across = max(runs[i, k, 0] - column, column - runs[i, k, 1], 0)
                    least = min(least, float(across * across + away * away))
        away += 1
    return sqrt(least)


@no_type_check
@njit(cache=True, fastmath=True)
def nearest_within(keys, queries, limit):
    """Index of the nearest key to each query in four dimensions, -1 where none is within the limit.

    Keys are sorted by their first column, so that few need to be looked at.
    """
    count = len(queries)
    found = np.full(count, -1, dtype=np.int64)
    for q in range(count):
        x, y, u, v = queries[q, 0], queries[q, 1], queries[q, 2], queries[q, 3]
        least = limit * limit
        for k in range(np.searchsorted(keys[:, 0], x - limit), len(keys)):
            dx = keys[k, 0] - x
            if dx > limit:
                break
            dy, du, dv = keys[k, 1] - y, keys[k, 2] - u, keys[k, 3] - v
            squared = dx * dx + dy * dy + du * du + dv * dv
            if squared < least:
                least = squared
                found[q] = k
    return found
