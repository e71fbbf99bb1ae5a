"""Compiled Eq. 1 and its partial derivatives."""

from math import exp, log, sqrt
from typing import no_type_check

import numpy as np
from numba import njit


@no_type_check
@njit(cache=True, error_model="numpy", nogil=True)
def shading_terms(positions, normals, direction, position, distance, is_point, exponent):
    """(k,) factors of albedo and of specularity in Eq. 1: l (l.n)_+ and l (h.n)_+^alpha."""
    count = positions.shape[0]
    diffuse = np.zeros(count)
    specular = np.zeros(count)
    for i in range(count):
        x, y, z = positions[i, 0], positions[i, 1], positions[i, 2]
        nx, ny, nz = normals[i, 0], normals[i, 1], normals[i, 2]
        lx, ly, lz = direction[0], direction[1], direction[2]
        intensity = 1.0
        if is_point:
            lx, ly, lz = position[0] - x, position[1] - y, position[2] - z
            range_to_light = sqrt(lx * lx + ly * ly + lz * lz)
            lx, ly, lz = lx / range_to_light, ly / range_to_light, lz / range_to_light
            intensity = (distance / range_to_light) ** 2
        cosine = lx * nx + ly * ny + lz * nz
        if cosine <= 0.0:
            continue
        diffuse[i] = intensity * cosine
        to_camera = 1.0 / sqrt(x * x + y * y + z * z)
        mx, my, mz = lx - x * to_camera, ly - y * to_camera, lz - z * to_camera
        mirror = (mx * nx + my * ny + mz * nz) / sqrt(mx * mx + my * my + mz * mz)
        if mirror > 0.0:
            specular[i] = intensity * exp(exponent * log(mirror))
    return diffuse, specular


@no_type_check
@njit(cache=True, error_model="numpy", nogil=True)
def shading_derivatives(
    positions,
    normals,
    albedo,
    specularity,
    direction,
    direction_by_angles,
    position,
    distance,
    is_point,
    exponent,
):
    """Factors of Eq. 1 and partial derivatives of the shading; zero where the light is behind."""
    count = positions.shape[0]
    diffuse = np.zeros(count)
    specular = np.zeros(count)
    by_position = np.zeros((count, 3))
    by_normal = np.zeros((count, 3))
    by_exponent = np.zeros(count)
    by_light = np.zeros((count, 3))
    by_centre = np.zeros((count, 3))
    to_light = np.empty(3)
    view = np.empty(3)
    halfway = np.empty(3)
    by_to_light = np.empty(3)
    by_view = np.empty(3)
    for i in range(count):
        range_to_light = 1.0
        intensity = 1.0
        range_to_camera = 0.0
        for axis in range(3):
            to_light[axis] = direction[axis]
            range_to_camera += positions[i, axis] ** 2
        range_to_camera = sqrt(range_to_camera)
        if is_point:
            range_to_light = 0.0
            for axis in range(3):
                to_light[axis] = position[axis] - positions[i, axis]
                range_to_light += to_light[axis] ** 2
            range_to_light = sqrt(range_to_light)
            intensity = (distance / range_to_light) ** 2
            for axis in range(3):
                to_light[axis] /= range_to_light
        cosine = 0.0
        middle = 0.0
        for axis in range(3):
            cosine += to_light[axis] * normals[i, axis]
            view[axis] = -positions[i, axis] / range_to_camera
            halfway[axis] = to_light[axis] + view[axis]
            middle += halfway[axis] ** 2
        if cosine <= 0.0:
            continue
        middle = sqrt(middle)
        mirror = 0.0
        for axis in range(3):
            halfway[axis] /= middle
            mirror += halfway[axis] * normals[i, axis]
        diffuse[i] = intensity * cosine
        by_mirror = 0.0
        if mirror > 0.0:
            logarithm = log(mirror)
            specular[i] = intensity * exp(exponent * logarithm)
            by_mirror = specularity[i] * exponent * specular[i] / mirror
            by_exponent[i] = specularity[i] * specular[i] * logarithm
        light_along = 0.0
        view_along = 0.0
        for axis in range(3):
            by_normal[i, axis] = albedo[i] * intensity * to_light[axis] + by_mirror * halfway[axis]
            # h = (l + v) / |l + v| moves with l and with v alike, at right angles to itself.
            by_view[axis] = by_mirror * (normals[i, axis] - mirror * halfway[axis]) / middle
            by_to_light[axis] = albedo[i] * intensity * normals[i, axis] + by_view[axis]
            light_along += by_to_light[axis] * to_light[axis]
            view_along += by_view[axis] * view[axis]
        lit = albedo[i] * diffuse[i] + specularity[i] * specular[i]
        for axis in range(3):
            # v = -x / |x|
            by_position[i, axis] = -(by_view[axis] - view_along * view[axis]) / range_to_camera
        if is_point:
            along_direction = 0.0
            for axis in range(3):
                # The light's position moves l = (L - x) / |L - x| and l's strength z^2 / |L - x|^2.
                by_source = (
                    by_to_light[axis] - light_along * to_light[axis] - 2.0 * lit * to_light[axis]
                ) / range_to_light
                by_position[i, axis] -= by_source
                by_centre[i, axis] = by_source
                along_direction += by_source * direction[axis]
                for angle in range(2):
                    by_light[i, angle] += by_source * distance * direction_by_angles[angle, axis]
            by_light[i, 2] = along_direction + 2.0 * lit / distance
        else:
            for axis in range(3):
                for angle in range(2):
                    by_light[i, angle] += by_to_light[axis] * direction_by_angles[angle, axis]
    return diffuse, specular, by_position, by_normal, by_exponent, by_light, by_centre
