"""Rotations from directions."""

import numpy as np
from jaxtyping import Float

from fitter.numerics.rotations import rotation_matrices
from fitter.numerics.vectors import cross_products, unit_vectors


def frames(
    across: Float[np.ndarray, "... 3"], along: Float[np.ndarray, "... 3"]
) -> Float[np.ndarray, "... 3 3"]:
    """Orthonormal frames (columns): second axis ``along``, first axis nearest to ``across``."""
    second = unit_vectors(along)
    first = unit_vectors(across - (across * second).sum(axis=-1, keepdims=True) * second)
    return np.stack([first, second, cross_products(first, second)], axis=-1)


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

    For opposite directions any perpendicular axis works; one is chosen.
    """
    start, end = np.broadcast_arrays(start, end)
    axis = cross_products(start, end)
    sine = np.sqrt((axis * axis).sum(axis=-1))
    cosine = (start * end).sum(axis=-1)
    helper = np.eye(3)[np.argmin(np.abs(start), axis=-1)]
    axis = np.where((sine > 1e-12)[..., None], axis, cross_products(start, helper))
    return turns(unit_vectors(axis), np.arctan2(sine, cosine))
