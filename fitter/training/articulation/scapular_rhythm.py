"""How much more of an arm's turn collar bone and shoulder blade take, the higher the arm."""

import numpy as np
from jaxtyping import Float

from fitter.arrays import Pose
from fitter.numerics.rotations import rotation_matrices

FROM_DEGREES, TO_DEGREES = 60.0, 160.0
"""Elevation, from straight down, over which the additional share grows from none to all of it."""


def raised_shares(turns: Pose, axes: Float[np.ndarray, "k 3"]) -> Float[np.ndarray, " k"]:
    """How far arms are raised: 0 below :data:`FROM_DEGREES`, 1 above :data:`TO_DEGREES`.

    Parameters
    ----------
    turns
        (k, 3) rotation vectors from rest, in axes whose y is the trunk's up.
    axes
        Unit directions of the arms at rest.
    """
    directions = np.einsum("kij,kj->ki", rotation_matrices(turns), axes)
    elevations = np.degrees(np.arccos(np.clip(-directions[:, 1], -1.0, 1.0)))
    return smooth_step((elevations - FROM_DEGREES) / (TO_DEGREES - FROM_DEGREES))


def smooth_step(way: np.ndarray) -> np.ndarray:
    """0 before 0, 1 after 1, and in between 3 t² - 2 t³."""
    t = np.clip(way, 0.0, 1.0)
    return t * t * (3.0 - 2.0 * t)
