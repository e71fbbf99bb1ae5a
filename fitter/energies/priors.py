"""Priors on the whole body: what is known about its shape, and that people stand upright."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from fitter.arrays import Pose, Shape
from fitter.numerics.rotations import rotation_matrices

LEAN_SPREAD = 0.2
"""Standard deviation of the sine of the angle by which the pelvis leans out of the picture's plane.
Leaning toward or away from the camera hardly changes the outline, so a faulty outline is easily
explained by it: without this prior a body leans back 40 degrees to cover ground with its feet.
People who lie down are recognised by their clicks, whose foreshortening far outweighs this prior.
"""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class ShapePrior:
    """What is known about the shape before the picture is seen, as N(m, P⁻¹).

    Attributes
    ----------
    mean
        (n,) m.
    precision
        (n, n) P. The height is given, not estimated: its row and column are zero.
    """

    mean: Shape
    precision: Float[np.ndarray, "n n"]

    def energy(self, shape: Shape) -> float:
        """½ (β - m)ᵀ P (β - m), nats."""
        return 0.5 * float((shape - self.mean)[1:] @ self.slope(shape)[1:])

    def slope(self, shape: Shape) -> Shape:
        """P (β - m), the derivative by the coefficients."""
        return self.precision @ (shape - self.mean)


def population_prior(count: int) -> ShapePrior:
    """The prior of the population: N(0, I) over ``count`` coefficients (section 4)."""
    precision = np.eye(count)
    precision[0, 0] = 0.0
    return ShapePrior(mean=np.zeros(count), precision=precision)


def lean_residual(pose: Pose) -> tuple[float, Float[np.ndarray, "3"]]:
    """Depth component of the pelvis' upward axis divided by its spread, and the derivative.

    The derivative is by the root's increment δ: d(R e_y) = δ × R e_y.
    """
    up = rotation_matrices(pose[:1])[0, :, 1]
    return float(up[2]) / LEAN_SPREAD, np.array([up[1], -up[0], 0.0]) / LEAN_SPREAD
