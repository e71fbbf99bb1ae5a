"""Numba kernels of :mod:`fitter.numerics.damped_descent`: damped steps, and the rule of damping.

Compiled for searches that are compiled themselves; all others use them too.
"""

from typing import NamedTuple, no_type_check

import numpy as np
from numba import njit

SMALLEST = 1e-6
# After Nielsen: damping falls, at most to a third, where the step gained what was predicted, rises
# where it gained less than half of that, and rises twice as fast with every further rejection.
# A fixed rise and fall had half of its evaluations rejected and ended 2 to 12 % higher.
FASTEST_FALL, FASTEST_RISE = 1.0 / 3.0, 5.0
FIRST_RISE = 2.0
PROMISED_AFTER_REJECTION = 0.7
"""Largest share of a rejected step's promise that the next one may make: with a damping so small
that it changes nothing, that step would end nearly where the rejected one did."""


class Damping(NamedTuple):
    """A share of the matrix's diagonal, and the factor by which the next rejection raises it."""

    share: float
    rise: float


@no_type_check
@njit(cache=True)
def damped_step(matrix, gradient, damping, floor):
    """(M + μ diag M + floor I) x = -g, and by how much ½ xᵀMx + gᵀx decreases."""
    damped = matrix.copy()
    for i in range(len(damped)):
        damped[i, i] += damping * matrix[i, i] + floor
    step = np.linalg.solve(damped, -gradient)
    return step, -np.dot(step, gradient + 0.5 * np.dot(matrix, step))


@no_type_check
@njit(cache=True)
def after_gain(damping, gain):
    """The damping after a step that gained this share of what it promised."""
    change = min(max(1.0 - (2.0 * gain - 1.0) ** 3, FASTEST_FALL), FASTEST_RISE)
    return Damping(max(damping.share * change, SMALLEST), FIRST_RISE)


@no_type_check
@njit(cache=True)
def after_rejection(damping):
    """The damping after a step that raised the energy, or that was not worth trying."""
    return Damping(damping.share * damping.rise, 2.0 * damping.rise)
