"""Eq. 1 (section 5): Blinn-Phong reflectance with ambient light, and its partial derivatives.

r_i = b + a_i (l_i . n_i)_+ l + s_i (h_i . n_i)_+^alpha l

with l_i the direction toward the light, h_i the halfway vector between l_i and the direction
toward the camera, and l the light's intensity at the vertex: 1 for a distant light, z^2 / d^2 for
a point light at distance d from the vertex and z from the body's centre.

The paper leaves open what a surface turned away from the light receives. Here it receives ambient
light alone: the negative cosine is cut off, and so is the highlight, which cannot come from a
light below the surface's horizon although h . n may be positive there. Cast shadows are not in
Eq. 1; :mod:`fitter.render.shadow` finds them.
"""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from fitter.arrays import Vector3
from fitter.parameters import Light, Reflectance
from fitter.render import _reflectance_kernels as kernels
from fitter.vocabulary.choices import LightKind


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


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class ShadingTerms:
    """Eq. 1 is linear in albedo, specularity and ambient: r = b + a ``diffuse`` + s ``specular``.

    Both (k,), in units of the light's intensity at the body's centre.
    """

    diffuse: Float[np.ndarray, " k"]
    specular: Float[np.ndarray, " k"]


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class ShadingDerivatives:
    """Shading r and its partial derivatives, each with the other arguments held.

    The derivative by ambient b is 1 everywhere. Where the light is behind the surface all others
    are 0; r jumps there if s > 0, which no derivative shows.

    Attributes
    ----------
    shading
        (k,) r.
    by_albedo, by_specularity
        (k,) also the factors of Eq. 1.
    by_position
        (k, 3) by the surface point, its normal and the body's centre held.
    by_normal
        (k, 3) by the normal as a free vector; the caller's normals stay unit by their own rule.
    by_exponent
        (k,) by alpha.
    by_light
        (k, 3) by azimuth, elevation and distance; the last is 0 for a directional light.
    by_body_centre
        (k, 3) by the centre the light's coordinates refer to: a point light moves with it.
    """

    shading: Float[np.ndarray, " k"]
    by_albedo: Float[np.ndarray, " k"]
    by_specularity: Float[np.ndarray, " k"]
    by_position: Float[np.ndarray, "k 3"]
    by_normal: Float[np.ndarray, "k 3"]
    by_exponent: Float[np.ndarray, " k"]
    by_light: Float[np.ndarray, "k 3"]
    by_body_centre: Float[np.ndarray, "k 3"]


def shading_terms(
    positions: Float[np.ndarray, "k 3"],
    normals: Float[np.ndarray, "k 3"],
    *,
    light: Light,
    body_centre: Vector3,
    specular_exponent: float,
) -> ShadingTerms:
    """Factors of albedo and specularity at surface points; camera frame, metres, unit normals."""
    diffuse, specular = kernels.shading_terms(
        _contiguous(positions),
        _contiguous(normals),
        direction_to_light(light),
        _source(light, body_centre),
        light.distance,
        light.kind is LightKind.POINT,
        specular_exponent,
    )
    return ShadingTerms(diffuse=diffuse, specular=specular)


def shade(
    positions: Float[np.ndarray, "k 3"],
    normals: Float[np.ndarray, "k 3"],
    *,
    light: Light,
    body_centre: Vector3,
    reflectance: Reflectance,
) -> Float[np.ndarray, " k"]:
    """Eq. 1 at k surface points, whose reflectance ``reflectance`` holds in the same order."""
    terms = shading_terms(
        positions,
        normals,
        light=light,
        body_centre=body_centre,
        specular_exponent=reflectance.specular_exponent,
    )
    return (
        reflectance.ambient
        + reflectance.albedo * terms.diffuse
        + reflectance.specularity * terms.specular
    )


def shade_with_derivatives(
    positions: Float[np.ndarray, "k 3"],
    normals: Float[np.ndarray, "k 3"],
    *,
    light: Light,
    body_centre: Vector3,
    reflectance: Reflectance,
) -> ShadingDerivatives:
    """Eq. 1 at k surface points with all its partial derivatives."""
    diffuse, specular, by_position, by_normal, by_exponent, by_light, by_centre = (
        kernels.shading_derivatives(
            _contiguous(positions),
            _contiguous(normals),
            _contiguous(reflectance.albedo),
            _contiguous(reflectance.specularity),
            direction_to_light(light),
            direction_derivatives(light),
            _source(light, body_centre),
            light.distance,
            light.kind is LightKind.POINT,
            reflectance.specular_exponent,
        )
    )
    return ShadingDerivatives(
        shading=(
            reflectance.ambient + reflectance.albedo * diffuse + reflectance.specularity * specular
        ),
        by_albedo=diffuse,
        by_specularity=specular,
        by_position=by_position,
        by_normal=by_normal,
        by_exponent=by_exponent,
        by_light=by_light,
        by_body_centre=by_centre,
    )


def _source(light: Light, body_centre: Vector3) -> Vector3:
    """Place of the light; a distant light has none, and the kernels do not look."""
    if light.kind is LightKind.DIRECTIONAL:
        return np.zeros(3)
    return light_position(light, body_centre)


def _contiguous(array: np.ndarray) -> np.ndarray:
    # One memory layout, one compiled version.
    return np.ascontiguousarray(array, dtype=np.float64)
