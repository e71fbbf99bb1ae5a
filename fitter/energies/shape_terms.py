"""Energies of the shape alone: its prior, and the measurements that the caller knows (section 4).

Section 4 rotates the shape space so that a single axis changes stature, and says that the same
works for any attribute measured on the mesh. A linear axis suffices for what is linear in the
shape, as stature is; a girth or a weight is slightly nonlinear, so it is measured anew at every
body a search visits. Measuring takes less than a millisecond, because in a fixed pose the vertices
are affine in the shape.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

import numpy as np
from jaxtyping import Float

from fitter.arrays import Shape

POPULATION_PRECISION: Final = 0.6
"""Precision of each coefficient in the prior of a fit; among the training subjects it is 1.

People elsewhere differ by more than two surveys and one maker's bodies do: with 1, heavy people
come out too light and lean ones too heavy, by home's truths as by foreign ones.
"""


USUAL_HEIGHT_SD: Final = 3.0
"""Heights within so many standard deviations of the mean are usual. Those whom the model was
learned from reach hardly farther: women of the survey from -2.8 to 3.3, men from -3.3 to 3.3."""

HEIGHT_CURVATURE: Final = 0.025
"""Bend of a person's other measurements away from a straight line in the height, in standard
deviations about that line, for each squared standard deviation of the height: the root mean square
of ANSUR II's 49 other fields among men. Among women it is 0.015."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class ShapePrior:
    """Knowledge of the shape before the picture is seen, as N(m, P⁻¹).

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


def population_prior(count: int, precision: float = POPULATION_PRECISION) -> ShapePrior:
    """The prior of people at large over ``count`` coefficients (section 4), wider than N(0, I)."""
    matrix = precision * np.eye(count)
    matrix[0, 0] = 0.0
    return ShapePrior(mean=np.zeros(count), precision=matrix)


def no_prior(count: int) -> ShapePrior:
    """Nothing is known: all shapes cost the same, as in the paper."""
    return ShapePrior(mean=np.zeros(count), precision=np.zeros((count, count)))


def height_extrapolation(height: float) -> float:
    """By what factor a shape's variance grows because nobody surveyed was of this height.

    ``height`` is the shape's first coefficient z. The other ones are what a straight line in the
    height leaves over. Nobody knows whether the line goes on beyond the people it was drawn
    through; bent by a curvature c it is off by c (z² - 1), with the mean square of c as the
    survey's own: 1 + (c (z² - 1))². That multiplies the whole covariance, what a picture says too:
    more than a prior of this width would do.
    """
    if abs(height) <= USUAL_HEIGHT_SD:
        return 1.0
    return 1.0 + (HEIGHT_CURVATURE * (height**2 - 1.0)) ** 2


ShapeEquations = tuple[Float[np.ndarray, "n n"], Float[np.ndarray, " n"]]
"""Matrix and gradient of an energy of the shape, nats."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Attributes:
    """Some measurements m(β) of a body and the values y they are known to have.

    Attributes
    ----------
    measure
        (r,) m at a shape, each in its unit.
    jacobian
        (r, n) their derivatives by the shape coefficients.
    values
        (r,) y.
    with_height
        Whether bodies that have these keep the height coefficient too.
    """

    measure: Callable[[Shape], Float[np.ndarray, " r"]]
    jacobian: Callable[[Shape], Float[np.ndarray, "r n"]]
    values: Float[np.ndarray, " r"]
    with_height: bool = True


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class KnownAttributes:
    """Known measurements besides the stature.

    Attributes
    ----------
    held
        Every body that is considered has these exactly.
    uncertain, standard_errors
        Bodies are drawn toward these according to their (r,) standard errors, in their units.
    """

    held: Attributes
    uncertain: Attributes
    standard_errors: Float[np.ndarray, " r"]


_NOTHING = Attributes(
    measure=lambda _: np.zeros(0),
    jacobian=lambda shape: np.zeros((0, len(shape))),
    values=np.zeros(0),
)

NOTHING_KNOWN = KnownAttributes(held=_NOTHING, uncertain=_NOTHING, standard_errors=np.zeros(0))
"""Nothing is known but the stature, given or assumed."""


def attribute_energy(known: KnownAttributes, shape: Shape) -> float:
    """½ Σ ((m_k(β) - y_k) / σ_k)² over the uncertain attributes, nats."""
    residuals = attribute_residuals(known, shape)
    return 0.5 * float(residuals @ residuals)


def attribute_equations(known: KnownAttributes, shape: Shape) -> ShapeEquations:
    """Matrix and gradient of :func:`attribute_energy` over the shape."""
    slopes = attribute_slopes(known, shape)
    return slopes.T @ slopes, slopes.T @ attribute_residuals(known, shape)


def attribute_residuals(known: KnownAttributes, shape: Shape) -> Float[np.ndarray, " r"]:
    """Residuals of the uncertain attributes, in standard errors."""
    return (known.uncertain.measure(shape) - known.uncertain.values) / known.standard_errors


def attribute_slopes(known: KnownAttributes, shape: Shape) -> Float[np.ndarray, "r n"]:
    """Derivative of the residuals by the shape coefficients."""
    return known.uncertain.jacobian(shape) / known.standard_errors[:, None]
