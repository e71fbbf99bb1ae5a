"""The likeliest body of a stature and a weight, and bodies drawn from the prior N(0, I)."""

import numpy as np
from jaxtyping import Float
from scipy.optimize import brentq

from fitter.arrays import Shape
from fitter.training.shapes.height_rotation import Attribute

GRADIENT_STEP = 0.05
"""Standard deviations."""

FARTHEST = 8.0
"""Standard deviations along the way of a weight within which it is looked for."""


def weight_direction(weight: Attribute, count: int) -> Shape:
    """Unit direction, with the height coefficient held, in which the mean body gains weight most.

    With a whitened shape space this is also the likeliest way to gain it: of all bodies of a weight
    that is linear in the shape, the one on this line is nearest to the mean.
    """
    steps = GRADIENT_STEP * np.eye(count)
    gradient = np.array([weight(step) - weight(-step) for step in steps])
    gradient[0] = 0.0
    return gradient / np.linalg.norm(gradient)


def body_of_weight(weight: Attribute, start: Shape, direction: Shape, weight_kg: float) -> Shape:
    """The body of a weight on the line through ``start`` along ``direction``.

    Raises
    ------
    ValueError
        If the line does not reach the weight within :data:`FARTHEST` standard deviations.
    """

    def missing(step: float) -> float:
        return weight(start + step * direction) - weight_kg

    return start + float(brentq(missing, -FARTHEST, FARTHEST)) * direction  # pyright: ignore


def random_shapes(count: int, size: int, rng: np.random.Generator) -> Float[np.ndarray, "k n"]:
    """Shapes β ~ N(0, I)."""
    return rng.normal(size=(count, size))
