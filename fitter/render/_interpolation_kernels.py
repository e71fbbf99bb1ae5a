"""Compiled interpolation of vertex values over a rendering."""

from typing import no_type_check

import numpy as np
from numba import njit


@no_type_check
@njit(cache=True, error_model="numpy", nogil=True)
def interpolate(face_ids, triangles, projected, depths, values, background):
    """(h, w) perspective-correct barycentric interpolation at pixel centres."""
    height, width = face_ids.shape
    picture = np.full((height, width), background, dtype=np.float32)
    for row in range(height):
        y = row + 0.5
        for column in range(width):
            t = face_ids[row, column]
            if t < 0:
                continue
            x = column + 0.5
            a, b, c = triangles[t, 0], triangles[t, 1], triangles[t, 2]
            ax, ay = projected[a, 0] - x, projected[a, 1] - y
            bx, by = projected[b, 0] - x, projected[b, 1] - y
            cx, cy = projected[c, 0] - x, projected[c, 1] - y
            # Areas opposite each corner, each divided by that corner's depth.
            wa = (bx * cy - cx * by) / depths[a]
            wb = (cx * ay - ax * cy) / depths[b]
            wc = (ax * by - bx * ay) / depths[c]
            picture[row, column] = (wa * values[a] + wb * values[b] + wc * values[c]) / (
                wa + wb + wc
            )
    return picture
