"""Body parameters as one vector of local increments: 3 p of pose, 3 of translation, n of shape."""

import numpy as np
from jaxtyping import Float

from fitter.body.scape import BodyDerivative, increment
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
