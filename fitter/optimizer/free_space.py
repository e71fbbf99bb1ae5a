"""The bodies a search may visit: all those with the held height and the held attributes.

The height coefficient stays where it is, unless it is free. Attributes held besides it leave, at
every body, the directions of shape in which none of them changes, the null space of their Jacobian
J without its height column: section 4's rotation of the shape space, renewed at each body. A step
along these directions changes an attribute in second order only, and is then projected back,

    β⁺ = β + J⁺ (y - m(β)).
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from fitter.arrays import Shape
from fitter.body.scape import BodyDerivative, increment
from fitter.energies.shape_terms import Attributes
from fitter.errors import NumericalError
from fitter.parameters import BodyParameters

# Longest single step: beyond it the linearisation means nothing.
_LONGEST_TURN = 0.35
_LONGEST_MOVE_M = 0.25
_LONGEST_SHAPE = 1.5


def moved(parameters: BodyParameters, step: Float[np.ndarray, " columns"]) -> BodyParameters:
    """Apply a vector of increments."""
    pose, translation, shape = _split(parameters, step)
    return increment(parameters, pose=pose, translation=translation, shape=shape)


def as_vector(derivative: BodyDerivative) -> Float[np.ndarray, " columns"]:
    """A derivative in the order of the vector."""
    return np.concatenate([derivative.pose.ravel(), derivative.translation, derivative.shape])


def excess(parameters: BodyParameters, step: Float[np.ndarray, " columns"]) -> float:
    """The length of a step as a share of the longest whose linearisation still holds."""
    pose, translation, shape = _split(parameters, step)
    return max(
        float(np.linalg.norm(pose, axis=1).max()) / _LONGEST_TURN,
        float(np.linalg.norm(translation)) / _LONGEST_MOVE_M,
        float(np.abs(shape).max()) / _LONGEST_SHAPE,
    )


def _split(
    parameters: BodyParameters, step: Float[np.ndarray, " columns"]
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    count = parameters.pose.size
    return step[:count].reshape(-1, 3), step[count : count + 3], step[count + 3 :]


HELD_WITHIN = 1e-3
"""Tolerance of held attributes, centimetres or kilograms."""

_STEPS_A_JACOBIAN = 5
_MOST_STEPS = 20

_SMALLEST_SHARE = 1e-5
"""Directions in which attributes change by less than this share of the largest change are not held:
two measurements that say the same hold the body once."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class FreeSpace:
    """The space of permitted changes of one shape.

    Attributes
    ----------
    directions
        (n, free) orthonormal changes of the shape, in columns; none changes the height coefficient
        where that is held.
    height_response
        (n,) smallest change of shape per unit of the height coefficient that keeps what is held.
    held
        The attributes every body has.
    slopes
        (r, n - 1) J at the shape.
    """

    directions: Float[np.ndarray, "n free"]
    height_response: Shape
    held: Attributes
    slopes: Float[np.ndarray, "r rest"]

    def moved(
        self,
        bodies: Sequence[BodyParameters],
        own: Sequence[Float[np.ndarray, " own"]],
        change: Shape,
    ) -> list[BodyParameters] | None:
        """Move bodies of one shape, and project the shape back to what is held.

        Parameters
        ----------
        bodies
            One in each picture.
        own
            The increments of pose and place in each picture.
        change
            What the shape changes, along the directions.

        Returns
        -------
        None if the shape ends too far from what is held.
        """
        reached = [
            moved(body, np.concatenate([step, change]))
            for body, step in zip(bodies, own, strict=True)
        ]
        kept = _brought_back(self.held, reached[0].shape, self.slopes)
        return None if kept is None else [replace(body, shape=kept) for body in reached]


def free_space(held: Attributes, shape: Shape) -> FreeSpace:
    """The space of changes of a shape that has what is held."""
    jacobian = held.jacobian(shape)
    slopes = jacobian[:, 1:]
    if held.with_height:
        kept = _kept_directions(slopes)
        directions = np.concatenate([np.zeros((1, kept.shape[1])), kept])
    else:
        directions = _kept_directions(jacobian)
    return FreeSpace(
        directions=directions,
        height_response=np.concatenate([[1.0], -_inverse(slopes) @ jacobian[:, 0]]),
        held=held,
        slopes=slopes,
    )


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
