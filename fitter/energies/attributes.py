"""Measurements of the body that the caller knows (section 4).

Section 4 rotates the shape space so that a single axis changes stature, and says that the same
works for any attribute measured on the mesh. A linear axis suffices for what is linear in the
shape, as stature is; a girth or a weight is slightly nonlinear, so it is measured anew at every
body a search visits. Measuring takes less than a millisecond, because in a fixed pose the vertices
are affine in the shape.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from fitter.arrays import Shape

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
