"""The bodies a search may visit: all those with the held height and the held attributes.

The height coefficient stays where it is. Attributes held besides it leave, at every body, the
directions of shape in which none of them changes, the null space of their Jacobian J without its
height column: section 4's rotation of the shape space, renewed at each body. A step along these
directions changes an attribute in second order only, and is then projected back,

    β⁺ = β + J⁺ (y - m(β)).
"""

from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from fitter.arrays import Shape
from fitter.energies.attributes import Attributes
from fitter.errors import NumericalError
from fitter.optimizer.parameter_vector import moved
from fitter.parameters import BodyParameters

HELD_WITHIN = 1e-3
"""Tolerance of held attributes, centimetres or kilograms."""

_STEPS_A_JACOBIAN = 5
_MOST_STEPS = 20

_SMALLEST_SHARE = 1e-5
"""Directions in which attributes change by less than this share of the largest change are not held:
two measurements that say the same hold the body once."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class FreeSpace:
    """The space of permitted steps from one body.

    Attributes
    ----------
    directions
        Orthonormal increments of the parameter vector, in columns; none changes the height
        coefficient.
    height_response
        (n,) smallest change of shape per unit of the height coefficient that keeps what is held.
    held
        The attributes every body has.
    slopes
        (r, n - 1) J at the body.
    """

    directions: Float[np.ndarray, "columns free"]
    height_response: Shape
    held: Attributes
    slopes: Float[np.ndarray, "r rest"]

    def moved(
        self, parameters: BodyParameters, step: Float[np.ndarray, " columns"]
    ) -> BodyParameters | None:
        """Apply increments and project the shape back to what is held; None if that is too far."""
        reached = moved(parameters, step)
        shape = _brought_back(self.held, reached.shape, self.slopes)
        return None if shape is None else replace(reached, shape=shape)


def free_space(held: Attributes, parameters: BodyParameters) -> FreeSpace:
    """The space of steps from a body that has what is held."""
    n = len(parameters.shape)
    jacobian = held.jacobian(parameters.shape)
    slopes = jacobian[:, 1:]
    shapes = _kept_directions(slopes)
    others = parameters.pose.size + 3
    directions = np.zeros((others + n, others + shapes.shape[1]))
    directions[:others, :others] = np.eye(others)
    directions[others + 1 :, others:] = shapes
    return FreeSpace(
        directions=directions,
        height_response=np.concatenate([[1.0], -_inverse(slopes) @ jacobian[:, 0]]),
        held=held,
        slopes=slopes,
    )


def kept_directions(held: Attributes, shape: Shape) -> Float[np.ndarray, "n free"]:
    """Orthonormal changes of a shape that keep its height and what is held, in columns."""
    kept = _kept_directions(held.jacobian(shape)[:, 1:])
    return np.concatenate([np.zeros((1, kept.shape[1])), kept])


def held_shape(held: Attributes, shape: Shape) -> Shape:
    """The nearest shape with the same height coefficient that has what is held.

    Raises
    ------
    NumericalError
        If there is none nearby.
    """
    found = _brought_back(held, shape, held.jacobian(shape)[:, 1:])
    if found is None:
        message = f"No body near shape {shape} has the attributes {held.values}."
        raise NumericalError(message)
    return found


def _brought_back(
    held: Attributes, shape: Shape, slopes: Float[np.ndarray, "r rest"]
) -> Shape | None:
    """Newton steps, reusing the Jacobian for some of them: attributes are nearly linear."""
    inverse = _inverse(slopes)
    for step in range(1, _MOST_STEPS + 1):
        missing = held.values - held.measure(shape)
        if np.abs(missing).max(initial=0.0) < HELD_WITHIN:
            return shape
        if not np.isfinite(missing).all():
            return None
        shape = np.concatenate([shape[:1], shape[1:] + inverse @ missing])
        if step % _STEPS_A_JACOBIAN == 0:
            inverse = _inverse(held.jacobian(shape)[:, 1:])
    return None


def _kept_directions(slopes: Float[np.ndarray, "r rest"]) -> Float[np.ndarray, "rest free"]:
    """Orthonormal null space; the axes themselves where nothing is held."""
    if not len(slopes):
        return np.eye(slopes.shape[1])
    _, sizes, axes = np.linalg.svd(slopes)
    return axes[np.count_nonzero(sizes > _SMALLEST_SHARE * sizes[0]) :].T


def _inverse(slopes: Float[np.ndarray, "r rest"]) -> Float[np.ndarray, "rest r"]:
    return np.linalg.pinv(slopes, rcond=_SMALLEST_SHARE) if len(slopes) else slopes.T
