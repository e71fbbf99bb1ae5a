"""A person's albedo by Eq. 1, point by point: the picture's colours with the light divided out."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from fitter.applications.seen_surface import (
    Beliefs,
    Colours,
    SeenSurface,
    SurfacePoints,
    smooth_step,
)
from fitter.numerics.rotations import unit_vectors
from fitter.observation.colour import luminance_of
from fitter.parameters import Light, Reflectance
from fitter.person.fitted_person import FittedPerson
from fitter.render.reflectance import shading_terms
from fitter.render.shadow import cast_shadow

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
            light=self.light,
            body_centre=self.body_centre,
            specular_exponent=self.reflectance.specular_exponent,
        )
        luminance = np.maximum(luminance_of(colours[None])[0], _LEAST_LUMINANCE)
        highlight = points.of(self.reflectance.specularity) * terms.specular * lit
        direct = terms.diffuse * lit
        without = np.maximum(1.0 - highlight / luminance, 0.0)
        around = self.reflectance.ambient / self.typical
        share = without / np.maximum(direct + around, DIM)
        return colours * share[:, None], belief * smooth_step(direct, DIM, LIT)
