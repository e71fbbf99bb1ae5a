"""A surface whose brightness was observed, and a light that may explain it."""

from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from fitter.arrays import Vector3
from fitter.parameters import Light


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class LitSurface:
    """Surface points with what was observed there; camera frame, metres.

    ``weights`` sum to one; ``albedo`` and ``specularity`` are held except for a common scale each;
    ``ambient_limit`` is as in :class:`fitter.optimizer.reflectance_solve.ReflectanceProblem`;
    ``lit`` is the share of the lamp that each sees, None where no cast shadow is known.
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
    lit: Float[np.ndarray, " k"] | None = None

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
            lit=None if self.lit is None else self.lit[chosen],
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
