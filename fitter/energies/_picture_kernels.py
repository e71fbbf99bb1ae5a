"""Numba kernels of the terms of the picture: silhouette, clothes, shading."""

from math import sqrt
from typing import NamedTuple, no_type_check

import numpy as np
from numba import njit


class Pixels(NamedTuple):
    """Pixels (h, w): the model's face ids, the observed region, distances to it, and confidence."""

    model: np.ndarray
    image: np.ndarray
    to_image: np.ndarray
    confidence: np.ndarray


class RobustCost(NamedTuple):
    """The scale of the robust function, the least cost beyond it, and how far it is looked at."""

    scale: float
    floor: float
    reach: float


class Clothes(NamedTuple):
    """Share of cloth of each pixel (h, w), and how full clothes are there (h, w, 2)."""

    cloth: np.ndarray
    fullness: np.ndarray


class EaseCost(NamedTuple):
    """The mean ease of clothes, its reach, and the weights of bare skin's cost and of its own."""

    mean: float
    reach: float
    of_skin: float
    of_ease: float


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
def robust_mismatch(pixels, cost):
    """Sum over unmatched pixels of confidence times ρ'(d), d the distance to the other region.

    Beyond the scale a pixel costs at least the floor, and beyond the reach exactly that: the model
    is not searched for any farther.
    """
    model, image, to_image, confidence = pixels
    scale, floor, reach = cost
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
            bound = d / (damping * damping)
            if d > scale and bound < floor:
                bound = floor
            total += bound * confidence[i, j]
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


@no_type_check
@njit(cache=True, error_model="numpy")
def facing_camera(vertices, normals, visible, least, result):
    """Visible vertices whose normal makes a cosine above ``least`` with the ray to the camera."""
    for i in range(len(vertices)):
        if not visible[i]:
            result[i] = False
            continue
        x, y, z = vertices[i, 0], vertices[i, 1], vertices[i, 2]
        along = x * normals[i, 0] + y * normals[i, 1] + z * normals[i, 2]
        result[i] = -along / sqrt(x * x + y * y + z * z) > least


_FAR_REACHES = 1.5


@no_type_check
@njit(cache=True, fastmath=True)
def clothed_mismatch(pixels, clothes, cost, ease_cost):
    """Sum over unmatched pixels of confidence times the derivative of the outline's cost.

    A pixel of the model outside the observed region costs what :func:`robust_mismatch` says, plus
    the cost of the ease its nearest cloth would have. A pixel of the region that the model does not
    cover costs the former to the extent that it is bare and the latter to the extent that it is
    cloth; within the mean ease, which is the usual one times the fullness, the latter is a gain.
    Beyond one and a half times the reach each pixel costs what it does there, so that a body does
    not become cheaper by leaving its clothes.
    """
    model, image, to_image, confidence = pixels
    cloth, full = clothes
    scale, floor, far = cost
    usual, reach, tight, loose = ease_cost
    runs, counts = _runs(model)
    total = 0.0
    inverse, inverse_reach = 1.0 / (scale * scale), 1.0 / (reach * reach)
    farthest = max(far, 2.0 * usual + 3.0 * reach)
    height, width = model.shape
    for i in range(height):
        for j in range(width):
            covered = model[i, j] >= 0
            if covered == image[i, j]:
                continue
            share = cloth[i, j]
            mean = usual * (full[i, j, 0] + full[i, j, 1])
            bare_farthest = farthest if share > 0.01 else far
            d = to_image[i, j] if covered else _distance_to(runs, counts, i, j, bare_farthest)
            damping = 1.0 + d * d * inverse
            bound = d / (damping * damping)
            if d > scale and bound < floor:
                bound = floor
            # Distances to the model are between centres, half a pixel more than to its outline.
            beyond = mean + d if covered else d - 0.5 - mean
            if not covered:
                bound *= 1.0 - share
                beyond = min(beyond, _FAR_REACHES * reach)
            damping = 1.0 + beyond * beyond * inverse_reach
            ease = beyond / (damping * damping)
            total += confidence[i, j] * (tight * bound + loose * share * ease)
    return total
