"""Numba kernels of pictures: averages over areas, and values between pixels."""

from typing import no_type_check

import numpy as np
from numba import njit, uint32


@no_type_check
@njit(cache=True, error_model="numpy", nogil=True)
def area_average(picture, table, pixels_per_pixel, width, height):
    """(height, width, c) float32 means of ``table[picture]`` over squares of the picture.

    Square (i, j) covers rows [i, i + 1) * pixels_per_pixel and columns alike; parts of pixels
    count by their area. ``pixels_per_pixel`` >= 1. One pass: a source row is summed along its
    columns once and then shared between the one or two rows it belongs to.
    """
    channels = picture.shape[2]
    result = np.zeros((height, width, channels), dtype=np.float32)
    line = np.empty((width, channels))
    area = pixels_per_pixel * pixels_per_pixel
    # The source columns of square j are firsts[j] and those after it, with the shares from
    # starts[j] to starts[j + 1].
    firsts = np.empty(width, dtype=np.int64)
    starts = np.empty(width + 1, dtype=np.int64)
    shares = np.empty(width + picture.shape[1])
    count = 0
    for j in range(width):
        left = j * pixels_per_pixel
        right = left + pixels_per_pixel
        firsts[j] = int(left)
        starts[j] = count
        for column in range(firsts[j], min(picture.shape[1], int(np.ceil(right)))):
            shares[count] = min(right, column + 1.0) - max(left, float(column))
            count += 1
    starts[width] = count
    row_end = min(picture.shape[0], int(np.ceil(height * pixels_per_pixel)))
    for row in range(row_end):
        for j in range(width):
            ahead = firsts[j] - starts[j]
            if channels == 3:
                # Three sums side by side do not wait for each other: half the time.
                red, green, blue = 0.0, 0.0, 0.0
                for k in range(starts[j], starts[j + 1]):
                    share = shares[uint32(k)]
                    column = uint32(ahead + k)
                    red += share * table[uint32(picture[uint32(row), column, uint32(0)])]
                    green += share * table[uint32(picture[uint32(row), column, uint32(1)])]
                    blue += share * table[uint32(picture[uint32(row), column, uint32(2)])]
                line[j, 0], line[j, 1], line[j, 2] = red, green, blue
                continue
            for channel in range(channels):
                total = 0.0
                for k in range(starts[j], starts[j + 1]):
                    level = picture[uint32(row), uint32(ahead + k), uint32(channel)]
                    total += shares[uint32(k)] * table[uint32(level)]
                line[j, channel] = total
        first_out = int(row / pixels_per_pixel)
        for i in range(first_out, min(first_out + 2, height)):
            top = i * pixels_per_pixel
            share = min(top + pixels_per_pixel, row + 1.0) - max(top, float(row))
            if share <= 0.0:
                continue
            for j in range(width):
                for channel in range(channels):
                    result[i, j, channel] += np.float32(share * line[j, channel] / area)
    return result


@no_type_check
@njit(cache=True, fastmath=True)
def bilinear(values, points, result):
    """Value and slopes at each point; columns of ``result``."""
    height, width = values.shape
    for k in range(len(points)):
        x = points[k, 0] - 0.5
        y = points[k, 1] - 0.5
        inside_x = 0.0 <= x <= width - 1
        inside_y = 0.0 <= y <= height - 1
        x = min(max(x, 0.0), width - 1.0)
        y = min(max(y, 0.0), height - 1.0)
        j = min(int(x), width - 2)
        i = min(int(y), height - 2)
        u = x - j
        v = y - i
        a, b = values[i, j], values[i, j + 1]
        c, d = values[i + 1, j], values[i + 1, j + 1]
        result[k, 0] = (a * (1 - u) + b * u) * (1 - v) + (c * (1 - u) + d * u) * v
        result[k, 1] = ((b - a) * (1 - v) + (d - c) * v) if inside_x else 0.0
        result[k, 2] = ((c - a) * (1 - u) + (d - b) * u) if inside_y else 0.0
