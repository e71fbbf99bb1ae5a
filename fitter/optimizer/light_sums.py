"""What the search for the light sums over the surface, without the terms that only it needs."""

import numpy as np
from jaxtyping import Float

from fitter.optimizer import _light_kernels as kernels
from fitter.optimizer.lit_surface import LightEstimate, LitSurface
from fitter.render.light import direction_derivatives, direction_to_light, light_position
from fitter.render.surroundings import harmonics
from fitter.vocabulary.choices import LightKind


class LightSums:
    """The robust energy of one surface's brightness, and its normal equations.

    Parameters
    ----------
    surface
        The points and what was observed there.
    surrounded
        Whether the lights that will be asked for have surroundings.
    """

    def __init__(self, surface: LitSurface, *, surrounded: bool) -> None:
        self._surface = surface
        self._points = (
            np.ascontiguousarray(surface.positions),
            np.ascontiguousarray(surface.normals),
            np.ascontiguousarray(surface.observed, dtype=np.float64),
            surface.weights,
        )
        lit = np.ones(len(surface.albedo)) if surface.lit is None else surface.lit
        self._lamp = lit * surface.albedo, lit * surface.specularity
        self._around = np.ones((len(lit), 1))
        if surrounded:
            self._around = surface.albedo[:, None] * harmonics(surface.normals)

    def energy(self, estimate: LightEstimate) -> float:
        """Σ_i w_i ρ_η(r_i - observed_i)."""
        surface, light = self._surface, estimate.light
        return kernels.data_energy(
            *self._points,
            *self._lamp,
            self._around,
            *_factors(estimate),
            direction_to_light(light),
            light_position(light, surface.body_centre) if _is_point(estimate) else np.zeros(3),
            light.distance,
            _is_point(estimate),
            surface.specular_exponent,
            surface.eta,
        )

    def normal_equations(
        self, estimate: LightEstimate
    ) -> tuple[Float[np.ndarray, "c c"], Float[np.ndarray, " c"]]:
        """Jᵀ W J and Jᵀ W r of half the reweighted squares, in the columns of ``light_columns``."""
        surface, light = self._surface, estimate.light
        return kernels.normal_equations(
            *self._points,
            *self._lamp,
            self._around,
            *_factors(estimate),
            direction_to_light(light),
            direction_derivatives(light),
            light_position(light, surface.body_centre) if _is_point(estimate) else np.zeros(3),
            light.distance,
            _is_point(estimate),
            surface.specular_exponent,
            surface.eta,
        )


def _is_point(estimate: LightEstimate) -> bool:
    return estimate.light.kind is LightKind.POINT


def _factors(estimate: LightEstimate) -> tuple[np.ndarray, np.ndarray]:
    """Levels of what does not come from the lamp, and the scales of albedo and specularity."""
    levels = np.array([estimate.ambient])
    if estimate.light.surroundings is not None:
        levels = estimate.albedo_scale * estimate.light.surroundings
    return levels, np.array([estimate.albedo_scale, estimate.specularity_scale])
