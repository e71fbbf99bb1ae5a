"""Compiled drawing of vertex colours, several samples to a pixel."""

from typing import no_type_check

import numpy as np
from numba import njit, uint32


@no_type_check
@njit(cache=True, error_model="numpy", nogil=True, inline="always")
def level_of(linear, first_levels, steps):
    """The level of a value; what lies beyond [0, 1] has the first or the last, no number the first.

    Level k begins at ``steps[k - 1]``; ``first_levels`` has the level at the beginning of each of
    its equal parts of [0, 1], and that of 1.
    """
    within = min(linear, 1.0) if linear > 0.0 else 0.0
    level = first_levels[int(within * (first_levels.shape[0] - 1))]
    while level < steps.shape[0] and within >= steps[level]:
        level += 1
    return level


@no_type_check
@njit(cache=True, error_model="numpy", nogil=True)
def levels_of(linear, first_levels, steps):
    """(n,) uint8 levels of (n,) values."""
    levels = np.empty(linear.shape[0], dtype=np.uint8)
    for i in range(linear.shape[0]):
        levels[i] = level_of(linear[i], first_levels, steps)
    return levels


SAMPLES = 2
"""A side of the square of samples in each pixel."""


@no_type_check
@njit(cache=True, error_model="numpy", nogil=True)
def value_planes(triangles, front_facing, projected, inverse_depths, values):
    """(f, 1 + c, 3) by x, by y and constant, of 1 and of each value, both over the depth.

    What is over the depth is affine over a triangle in the image; a value is its plane over the
    first. Only front faces have planes; the factor they share, their area, cancels.
    """
    columns = values.shape[1]
    planes = np.empty((triangles.shape[0], 1 + columns, 3))
    for t in range(triangles.shape[0]):
        if not front_facing[t]:
            continue
        for column in range(1 + columns):
            for axis in range(3):
                planes[t, column, axis] = 0.0
        for corner in range(3):
            a = triangles[t, corner]
            b, c = triangles[t, (corner + 1) % 3], triangles[t, (corner + 2) % 3]
            # Twice the area of the triangle that a point spans with the edge opposite the corner.
            share = inverse_depths[a]
            by_x = (projected[b, 1] - projected[c, 1]) * share
            by_y = (projected[c, 0] - projected[b, 0]) * share
            constant = (
                projected[b, 0] * projected[c, 1] - projected[c, 0] * projected[b, 1]
            ) * share
            for column in range(1 + columns):
                value = values[a, column - 1] if column > 0 else 1.0
                planes[t, column, 0] += by_x * value
                planes[t, column, 1] += by_y * value
                planes[t, column, 2] += constant * value
    return planes


@no_type_check
@njit(cache=True, error_model="numpy", nogil=True)
def draw_levels(
    face_ids,
    planes,
    background,
    channels,
    first_levels,
    steps,
    left,
    top,
    pictures,
):
    """Write the levels of means of ``SAMPLES`` x ``SAMPLES`` samples into (k, h, w, 3) pictures.

    The samples ``face_ids`` are those of the part of the pictures that begins at ``left``, ``top``.
    Values are clipped to [0, 1] at every sample; picture p's channel q shows value
    ``channels[p, q]``. ``first_levels`` and ``steps`` are those of :func:`level_of`. Pixels without
    any sample on the body are left as they are.
    """
    count = pictures.shape[0]
    height, width = face_ids.shape[0] // SAMPLES, face_ids.shape[1] // SAMPLES
    columns = planes.shape[1] - 1
    sums = np.zeros(columns)
    levels = np.empty(columns, dtype=np.uint8)
    share = 1.0 / (SAMPLES * SAMPLES)
    for row in range(height):
        for column in range(width):
            seen = -1
            for sample in range(SAMPLES * SAMPLES):
                i = uint32(row * SAMPLES + sample // SAMPLES)
                j = uint32(column * SAMPLES + sample % SAMPLES)
                seen &= face_ids[i, j]
            if seen == -1:
                continue
            paper = 0.0
            for sample in range(SAMPLES * SAMPLES):
                i = uint32(row * SAMPLES + sample // SAMPLES)
                j = uint32(column * SAMPLES + sample % SAMPLES)
                t = face_ids[i, j]
                if t < 0:
                    paper += background
                    continue
                u = uint32(t)
                x, y = j + 0.5, i + 0.5
                scale = 1.0 / (planes[u, 0, 0] * x + planes[u, 0, 1] * y + planes[u, 0, 2])
                for k in range(columns):
                    value = (
                        planes[u, k + 1, 0] * x + planes[u, k + 1, 1] * y + planes[u, k + 1, 2]
                    ) * scale
                    sums[k] += min(value, 1.0) if value > 0.0 else 0.0
            for k in range(columns):
                levels[k] = level_of((sums[k] + paper) * share, first_levels, steps)
                sums[k] = 0.0
            for p in range(count):
                for q in range(3):
                    pictures[p, top + row, left + column, q] = levels[channels[p, q]]
