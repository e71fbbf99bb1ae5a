"""Rotations from directions."""

import numpy as np
from jaxtyping import Float

from fitter.numerics.rotations import rotation_matrices


def normalized(vectors: Float[np.ndarray, "... 3"]) -> Float[np.ndarray, "... 3"]:
    """Unit vectors; a zero vector stays zero."""
    return vectors / np.maximum(np.linalg.norm(vectors, axis=-1, keepdims=True), 1e-300)


def frames(
    across: Float[np.ndarray, "... 3"], along: Float[np.ndarray, "... 3"]
) -> Float[np.ndarray, "... 3 3"]:
    """Orthonormal frames (columns) with the second axis along, the first nearest to across."""
    second = normalized(along)
    first = normalized(across - (across * second).sum(axis=-1, keepdims=True) * second)
    return np.stack([first, second, np.cross(first, second)], axis=-1)


def turns(
    axis: Float[np.ndarray, "... 3"], angle: Float[np.ndarray, "..."]
) -> Float[np.ndarray, "... 3 3"]:
    """Rotations about unit axes, radians."""
    vectors = axis * angle[..., None]
    return rotation_matrices(vectors.reshape(-1, 3)).reshape(*vectors.shape, 3)


def swings(
    start: Float[np.ndarray, "... 3"], end: Float[np.ndarray, "... 3"]
) -> Float[np.ndarray, "... 3 3"]:
    """The smallest rotations that turn unit vectors ``start`` into unit vectors ``end``.

    Between opposite directions every perpendicular axis serves; one is chosen.
    """
    start, end = np.broadcast_arrays(start, end)
    axis = np.cross(start, end)
    sine = np.linalg.norm(axis, axis=-1)
    cosine = (start * end).sum(axis=-1)
    helper = np.eye(3)[np.argmin(np.abs(start), axis=-1)]
    axis = np.where((sine > 1e-12)[..., None], axis, np.cross(start, helper))
    return turns(normalized(axis), np.arctan2(sine, cosine))
