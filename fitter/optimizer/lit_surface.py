"""A surface whose brightness was observed, a light that may explain it, and how well it does."""

from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from fitter.arrays import Vector3
from fitter.optimizer import _light_kernels as kernels
from fitter.parameters import Light
from fitter.render.reflectance import direction_derivatives, direction_to_light, light_position
from fitter.vocabulary.choices import LightKind


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class LitSurface:
    """Surface points with what was observed there; camera frame, metres.

    ``weights`` sum to one; ``albedo`` and ``specularity`` are held except for a common scale each;
    ``ambient_limit`` is as in :class:`fitter.optimizer.reflectance_solve.ReflectanceProblem`.
    """

    positions: Float[np.ndarray, "k 3"]
    normals: Float[np.ndarray, "k 3"]
    observed: Float[np.ndarray, " k"]
    weights: Float[np.ndarray, " k"]
    albedo: Float[np.ndarray, " k"]
    specularity: Float[np.ndarray, " k"]
    ambient_limit: float
    body_centre: Vector3
    specular_exponent: float
    eta: float

    def thinned(self, limit: int) -> "LitSurface":
        """About ``limit`` of the points, at even steps, standing for all."""
        step = -(-len(self.observed) // limit)
        chosen = slice(step // 2, None, step)
        weights = self.weights[chosen]
        total = float(weights.sum())
        if step <= 1 or not total > 0.0:
            return self
        return replace(
            self,
            positions=self.positions[chosen],
            normals=self.normals[chosen],
            observed=self.observed[chosen],
            weights=weights / total,
            albedo=self.albedo[chosen],
            specularity=self.specularity[chosen],
        )


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class LightEstimate:
    """A light and the scales of reflectance that go with it; ``energy`` is robust, in [0, 1]."""

    light: Light
    ambient: float
    albedo_scale: float
    specularity_scale: float
    energy: float

    @property
    def total(self) -> float:
        """The energy, as searches ask for it."""
        return self.energy


class LightSums:
    """Sums over a surface in the search for its light, without the terms that only it needs."""

    def __init__(self, surface: LitSurface) -> None:
        self._surface = surface
        self._points = kernels.LitPoints(
            positions=np.ascontiguousarray(surface.positions),
            normals=np.ascontiguousarray(surface.normals),
            observed=np.ascontiguousarray(surface.observed, dtype=np.float64),
            weights=surface.weights,
            albedo=surface.albedo,
            specularity=surface.specularity,
        )

    def energy(self, estimate: LightEstimate) -> float:
        """Σ_i w_i ρ_η(r_i - observed_i)."""
        return kernels.data_energy(
            self._points, self._lamp(estimate.light), _levels(estimate), self._surface.eta
        )

    def normal_equations(
        self, estimate: LightEstimate
    ) -> tuple[Float[np.ndarray, "6 6"], Float[np.ndarray, "6"]]:
        """Jᵀ W J and Jᵀ W r of half the reweighted squares, in the columns of ``light_columns``."""
        return kernels.normal_equations(
            self._points,
            self._lamp(estimate.light),
            direction_derivatives(estimate.light),
            _levels(estimate),
            self._surface.eta,
        )

    def _lamp(self, light: Light) -> kernels.Lamp:
        is_point = light.kind is LightKind.POINT
        return kernels.Lamp(
            direction=direction_to_light(light),
            source=light_position(light, self._surface.body_centre) if is_point else np.zeros(3),
            distance=light.distance,
            is_point=is_point,
            exponent=self._surface.specular_exponent,
        )


def _levels(estimate: LightEstimate) -> kernels.Levels:
    return kernels.Levels(
        ambient=estimate.ambient,
        albedo=estimate.albedo_scale,
        specularity=estimate.specularity_scale,
    )
