"""Numba kernel of the shading energy."""

from math import sqrt
from typing import no_type_check

from numba import njit


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
