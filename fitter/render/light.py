"""The light of section 5: a point light with quadratic attenuation, or a distant one."""

import numpy as np
from jaxtyping import Float

from fitter.arrays import Vector3
from fitter.parameters import Light


def direction_to_light(light: Light) -> Vector3:
    """Unit vector from the body's centre toward the light, camera frame."""
    return np.array(
        [
            np.cos(light.elevation) * np.sin(light.azimuth),
            -np.sin(light.elevation),
            -np.cos(light.elevation) * np.cos(light.azimuth),
        ]
    )


def direction_derivatives(light: Light) -> Float[np.ndarray, "2 3"]:
    """Derivatives of :func:`direction_to_light` with respect to azimuth and to elevation."""
    sin_azimuth, cos_azimuth = np.sin(light.azimuth), np.cos(light.azimuth)
    sin_elevation, cos_elevation = np.sin(light.elevation), np.cos(light.elevation)
    return np.array(
        [
            [cos_elevation * cos_azimuth, 0.0, cos_elevation * sin_azimuth],
            [-sin_elevation * sin_azimuth, -cos_elevation, sin_elevation * cos_azimuth],
        ]
    )


def light_position(light: Light, body_centre: Vector3) -> Vector3:
    """Position of a point light, camera frame, metres."""
    return body_centre + light.distance * direction_to_light(light)
