"""Compiled sums of the search for the light; :mod:`fitter.optimizer.light_solve` documents them."""

from math import exp, log, sqrt
from typing import NamedTuple, no_type_check

import numpy as np
from numba import njit


class LitPoints(NamedTuple):
    """Points (k, 3) of a surface, what was observed there, and the reflectance to scale, (k,)."""

    positions: np.ndarray
    normals: np.ndarray
    observed: np.ndarray
    weights: np.ndarray
    albedo: np.ndarray
    specularity: np.ndarray


class Lamp(NamedTuple):
    """The light of Eq. 1: where it is, whether it has a place, and the exponent of its gloss."""

    direction: np.ndarray
    source: np.ndarray
    distance: float
    is_point: bool
    exponent: float


class Levels(NamedTuple):
    """The ambient light, and the scales of albedo and specularity."""

    ambient: float
    albedo: float
    specularity: float


@no_type_check
@njit(cache=True, nogil=True, error_model="numpy")
def data_energy(points, lamp, levels, eta):
    """Σ_i w_i ρ_η(r_i - observed_i); see :func:`normal_equations`."""
    positions, normals, observed, weights, albedo, specularity = points
    direction, source, distance, is_point, exponent = lamp
    total = 0.0
    for i in range(observed.size):
        predicted = levels.ambient
        x, y, z = positions[i, 0], positions[i, 1], positions[i, 2]
        nx, ny, nz = normals[i, 0], normals[i, 1], normals[i, 2]
        lx, ly, lz = direction[0], direction[1], direction[2]
        strength = 1.0
        if is_point:
            lx, ly, lz = source[0] - x, source[1] - y, source[2] - z
            away = sqrt(lx * lx + ly * ly + lz * lz)
            lx, ly, lz = lx / away, ly / away, lz / away
            strength = (distance / away) ** 2
        cosine = lx * nx + ly * ny + lz * nz
        if cosine > 0.0:
            predicted += levels.albedo * albedo[i] * strength * cosine
            to_camera = 1.0 / sqrt(x * x + y * y + z * z)
            hx, hy, hz = lx - x * to_camera, ly - y * to_camera, lz - z * to_camera
            mirror = (hx * nx + hy * ny + hz * nz) / sqrt(hx * hx + hy * hy + hz * hz)
            if mirror > 0.0:
                gloss = strength * exp(exponent * log(mirror))
                predicted += levels.specularity * specularity[i] * gloss
        squared = (predicted - observed[i]) ** 2
        total += weights[i] * squared / (eta * eta + squared)
    return total


@no_type_check
@njit(cache=True, nogil=True, error_model="numpy")
def normal_equations(points, lamp, direction_by_angles, levels, eta):
    """Jᵀ W J and Jᵀ W (r - observed) of Eq. 1 with the weights of Geman and McClure's function.

    The columns are those of ``light_columns``.
    """
    positions, normals, observed, weights, albedo, specularity = points
    direction, source, distance, is_point, exponent = lamp
    columns = 6
    matrix = np.zeros((columns, columns))
    gradient = np.zeros(columns)
    row = np.zeros(columns)
    to_light = np.empty(3)
    halfway = np.empty(3)
    for i in range(observed.size):
        predicted = levels.ambient
        row[0] = row[1] = row[2] = row[4] = row[5] = 0.0
        row[3] = 1.0
        away = 1.0
        strength = 1.0
        to_camera = 0.0
        for axis in range(3):
            to_light[axis] = direction[axis]
            to_camera += positions[i, axis] ** 2
        if is_point:
            away = 0.0
            for axis in range(3):
                to_light[axis] = source[axis] - positions[i, axis]
                away += to_light[axis] ** 2
            away = sqrt(away)
            strength = (distance / away) ** 2
            for axis in range(3):
                to_light[axis] /= away
        cosine = 0.0
        for axis in range(3):
            cosine += to_light[axis] * normals[i, axis]
        if cosine > 0.0:
            middle = 0.0
            for axis in range(3):
                halfway[axis] = to_light[axis] - positions[i, axis] / sqrt(to_camera)
                middle += halfway[axis] ** 2
            middle = sqrt(middle)
            mirror = 0.0
            for axis in range(3):
                halfway[axis] /= middle
                mirror += halfway[axis] * normals[i, axis]
            diffuse = strength * cosine
            specular = 0.0
            by_mirror = 0.0
            matt = levels.albedo * albedo[i]
            glossy = levels.specularity * specularity[i]
            if mirror > 0.0:
                specular = strength * exp(exponent * log(mirror))
                by_mirror = glossy * exponent * specular / mirror
            lit = matt * diffuse + glossy * specular
            predicted += lit
            along = 0.0
            for axis in range(3):
                along += (
                    _by_direction(
                        axis, matt * strength, normals[i, axis], by_mirror, mirror, halfway, middle
                    )
                    * to_light[axis]
                )
            for axis in range(3):
                slope = _by_direction(
                    axis, matt * strength, normals[i, axis], by_mirror, mirror, halfway, middle
                )
                reach = 1.0
                if is_point:
                    # The light's position moves its direction and its strength z² / |L - x|².
                    slope = (slope - (along + 2.0 * lit) * to_light[axis]) / away
                    reach = distance
                    row[2] += distance * slope * direction[axis]
                for angle in range(2):
                    row[angle] += reach * slope * direction_by_angles[angle, axis]
            if is_point:
                row[2] += 2.0 * lit
            row[4] = albedo[i] * diffuse
            row[5] = specularity[i] * specular
        residual = predicted - observed[i]
        total = eta * eta + residual * residual
        weight = weights[i] * 2.0 * eta * eta / (total * total)
        for a in range(columns):
            pull = weight * row[a]
            gradient[a] += pull * residual
            for b in range(a + 1):
                matrix[a, b] += pull * row[b]
    for a in range(columns):
        for b in range(a):
            matrix[b, a] = matrix[a, b]
    return matrix, gradient


@no_type_check
@njit(cache=True, nogil=True, error_model="numpy")
def _by_direction(axis, matt, normal, by_mirror, mirror, halfway, middle):
    """Derivative of the brightness by the direction toward the light."""
    return matt * normal + by_mirror * (normal - mirror * halfway[axis]) / middle
