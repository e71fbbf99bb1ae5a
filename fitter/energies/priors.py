"""The prior on the shape: what is known about it before the picture is seen."""

from dataclasses import dataclass
from typing import Final

import numpy as np
from jaxtyping import Float

from fitter.arrays import Shape

POPULATION_PRECISION: Final = 0.6
"""Of each coefficient under the prior of a fit; among those the model was learned from it is 1.

People elsewhere differ by more than two surveys and one maker's bodies do: with 1, heavy people
come out too light and lean ones too heavy, by home's truths as by foreign ones.
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
    """The prior of people at large over ``count`` coefficients (section 4), wider than N(0, I)."""
    precision = POPULATION_PRECISION * np.eye(count)
    precision[0, 0] = 0.0
    return ShapePrior(mean=np.zeros(count), precision=precision)
