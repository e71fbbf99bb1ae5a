"""What the caller knows of the body's measures (section 4).

Section 4 rotates the shape space so that one axis alone changes stature, and says that the same
serves any attribute measured on the mesh. One linear axis holds what is linear in the shape, as
stature is; a girth or a weight bends a little, so it is measured wherever a search goes. Measuring
takes less than a millisecond, because in one pose vertices are affine in the shape.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from fitter.arrays import Shape


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Attributes:
    """Some measurements m(β) of a body and the values y they are known to have.

    Attributes
    ----------
    measure
        (r,) m at a shape, each in its unit.
    jacobian
        (r, n) of them by the coefficients.
    values
        (r,) y.
    """

    measure: Callable[[Shape], Float[np.ndarray, " r"]]
    jacobian: Callable[[Shape], Float[np.ndarray, "r n"]]
    values: Float[np.ndarray, " r"]


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class KnownAttributes:
    """What is known beside the stature.

    Attributes
    ----------
    held
        Every body that is looked at has these exactly.
    uncertain, standard_errors
        Bodies are drawn toward these as far as they are certain; (r,) in their units.
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
"""Of whom only the stature is given or assumed."""


def whole_shape(shape: Shape) -> KnownAttributes:
    """Of whom every coefficient is known: a search keeps to this shape, and moves the rest."""
    every = Attributes(
        measure=lambda shape: shape, jacobian=lambda shape: np.eye(len(shape)), values=shape
    )
    return replace(NOTHING_KNOWN, held=every)


def attribute_energy(known: KnownAttributes, shape: Shape) -> float:
    """½ Σ ((m_k(β) - y_k) / σ_k)² over the uncertain attributes, nats."""
    residuals = attribute_residuals(known, shape)
    return 0.5 * float(residuals @ residuals)


def attribute_residuals(known: KnownAttributes, shape: Shape) -> Float[np.ndarray, " r"]:
    """Of the uncertain attributes, in standard errors."""
    return (known.uncertain.measure(shape) - known.uncertain.values) / known.standard_errors


def attribute_slopes(known: KnownAttributes, shape: Shape) -> Float[np.ndarray, "r n"]:
    """Derivative of the residuals by the shape coefficients."""
    return known.uncertain.jacobian(shape) / known.standard_errors[:, None]
