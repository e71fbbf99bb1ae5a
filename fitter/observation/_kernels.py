"""Compiled area averaging of a large picture in linear light."""

from typing import no_type_check

import numpy as np
from numba import njit


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
    line = np.zeros((width, channels))
    area = pixels_per_pixel * pixels_per_pixel
    row_end = min(picture.shape[0], int(np.ceil(height * pixels_per_pixel)))
    for row in range(row_end):
        for j in range(width):
            left = j * pixels_per_pixel
            right = left + pixels_per_pixel
            first = int(left)
            end = min(picture.shape[1], int(np.ceil(right)))
            for channel in range(channels):
                line[j, channel] = 0.0
            for column in range(first, end):
                share = min(right, column + 1.0) - max(left, float(column))
                for channel in range(channels):
                    line[j, channel] += share * table[picture[row, column, channel]]
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
