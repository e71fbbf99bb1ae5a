"""A person's albedo by Eq. 1, point by point: the picture's colours with the light divided out."""

from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Bool, Float

from fitter.applications.seen_surface import (
    Beliefs,
    Colours,
    SeenSurface,
    SurfacePoints,
    smooth_step,
)
from fitter.arrays import Vector3
from fitter.numerics.mesh_topology import mesh_topology
from fitter.numerics.vectors import unit_vectors
from fitter.observation.colour import luminance_of
from fitter.parameters import Light, Reflectance
from fitter.person.fitted_person import FittedPerson
from fitter.render.rasterizer import Rendering
from fitter.render.reflectance import shading_terms
from fitter.render.shadow import cast_shadow, penumbra
from fitter.render.surroundings import irradiance

DIM, LIT = 0.1, 0.35
"""Shares of the lamp's light: below the first an albedo is noise divided by little, and the rest of
the light is only roughly known; from the second on it is believed wholly."""

_LEAST_LUMINANCE = 1e-3


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class LitSurface:
    """Eq. 1 over the surface of a person in their light."""

    surface: SeenSurface
    light: Light
    reflectance: Reflectance
    body_centre: Float[np.ndarray, "3"]
    lit: Float[np.ndarray, " m"]
    sharp: Float[np.ndarray, " m"]
    typical: float

    @classmethod
    def of(
        cls,
        surface: SeenSurface,
        person: FittedPerson,
        light: Light,
        reflectance: Reflectance,
    ) -> "LitSurface":
        """Of a surface before its picture, in the light that the fit found."""
        rendering, centre = surface.rendering, person.body.translation
        shadowed = cast_shadow(
            rendering.vertices, rendering.triangles, light=light, body_centre=centre
        )
        typical = float(np.median(reflectance.albedo[rendering.vertex_visible]))
        return cls(
            surface=surface,
            light=light,
            reflectance=reflectance,
            body_centre=centre,
            lit=1.0 - shadowed,
            sharp=1.0 - _penumbra(rendering, shadowed, light, centre),
            typical=max(typical, _LEAST_LUMINANCE),
        )

    def albedo(
        self, points: SurfacePoints, colours: Colours, belief: Beliefs
    ) -> tuple[Colours, Beliefs]:
        """Albedo of points whose linear colours are seen, and how far it is believed."""
        rendering, lit = self.surface.rendering, points.of(self.lit)
        normals = unit_vectors(points.of(rendering.vertex_normals))
        terms = shading_terms(
            points.of(rendering.vertices),
            normals,
            light=replace(self.light, surroundings=None),
            body_centre=self.body_centre,
            specular_exponent=self.reflectance.specular_exponent,
        )
        luminance = np.maximum(luminance_of(colours[None])[0], _LEAST_LUMINANCE)
        highlight = points.of(self.reflectance.specularity) * terms.specular * lit
        direct = terms.diffuse * lit
        without = np.maximum(1.0 - highlight / luminance, 0.0)
        if self.light.surroundings is None:
            around = self.reflectance.ambient / self.typical
            known = direct
        else:
            around = irradiance(self.light.surroundings, normals)
            known = direct + around
            belief = belief * points.of(self.sharp)
        share = without / np.maximum(direct + around, DIM)
        return colours * share[:, None], belief * smooth_step(known, DIM, LIT)


def _penumbra(
    rendering: Rendering, shadowed: Bool[np.ndarray, " m"], light: Light, body_centre: Vector3
) -> Bool[np.ndarray, " m"]:
    lamp = shading_terms(
        rendering.vertices,
        rendering.vertex_normals,
        light=replace(light, surroundings=None),
        body_centre=body_centre,
        specular_exponent=1.0,
    )
    edges = mesh_topology(rendering.triangles, vertex_count=len(shadowed)).edges
    return penumbra(shadowed, lamp.diffuse > 0.0, edges)
