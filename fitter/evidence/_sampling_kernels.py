"""Numba kernel of bilinear sampling."""

from typing import no_type_check

from numba import njit


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
