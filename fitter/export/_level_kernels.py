"""Compiled coding of linear values to the levels of a file, by a table."""

from typing import no_type_check

import numpy as np
from numba import njit


@no_type_check
@njit(cache=True, error_model="numpy", nogil=True, inline="always")
def level_of(linear, first_levels, steps):
    """The level of a value; what lies beyond [0, 1] has the first or the last, no number the first.

    Level k begins at ``steps[k - 1]``; ``first_levels`` has the level at the beginning of each of
    its equal parts of [0, 1], and that of 1.
    """
    within = min(linear, 1.0) if linear > 0.0 else 0.0
    level = first_levels[int(within * (first_levels.shape[0] - 1))]
    while level < steps.shape[0] and within >= steps[level]:
        level += 1
    return level


@no_type_check
@njit(cache=True, error_model="numpy", nogil=True)
def levels_of(linear, first_levels, steps):
    """(n,) uint8 levels of (n,) values."""
    levels = np.empty(linear.shape[0], dtype=np.uint8)
    for i in range(linear.shape[0]):
        levels[i] = level_of(linear[i], first_levels, steps)
    return levels
