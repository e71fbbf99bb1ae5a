"""A share of a rotation: swing and twist, scaled separately."""

import numpy as np
from jaxtyping import Float

from fitter.arrays import Rotations
from fitter.numerics.rotations import rotation_matrices, rotation_vectors


def swing_and_twist(
    vectors: Float[np.ndarray, "k 3"], axes: Float[np.ndarray, "k 3"]
) -> tuple[Float[np.ndarray, "k 3"], Float[np.ndarray, " k"]]:
    """Split R = S T into a twist T about an axis, applied first, and a swing S across it.

    Returns
    -------
    swing
        (k, 3) rotation vectors of S, perpendicular to the axes.
    twist
        (k,) angles of T about the axes, radians, in (-π, π].
    """
    angle = np.linalg.norm(vectors, axis=1)
    half_sine = 0.5 * np.sinc(0.5 * angle / np.pi)
    twist = 2.0 * np.arctan2(half_sine * np.einsum("ki,ki->k", vectors, axes), np.cos(angle / 2.0))
    twist = np.where(twist > np.pi, twist - 2.0 * np.pi, twist)
    twist = np.where(twist <= -np.pi, twist + 2.0 * np.pi, twist)
    untwist = rotation_matrices(-twist[:, None] * axes)
    return rotation_vectors(rotation_matrices(vectors) @ untwist), twist


def partial_rotations(
    vectors: Float[np.ndarray, "k 3"],
    axes: Float[np.ndarray, "k 3"],
    swing_share: Float[np.ndarray, " k"],
    twist_share: Float[np.ndarray, " k"],
) -> Rotations:
    """Rotations S^swing_share T^twist_share."""
    swing, twist = swing_and_twist(vectors, axes)
    return rotation_matrices(swing_share[:, None] * swing) @ rotation_matrices(
        (twist_share * twist)[:, None] * axes
    )
