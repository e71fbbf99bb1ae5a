"""Damped Gauss-Newton on clicks, from each of a batch of poses.

Minimises the energy of :mod:`fitter.pose_init.click_problem`. A step is accepted only if the energy
decreases. Rotations are updated as exp(δ) exp(pose), which has no pole.
"""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Integer

from fitter.arrays import Points2D
from fitter.body.joint_limits import LIMIT_SOFTNESS_DEG
from fitter.body.skeleton import descendants
from fitter.pose_init._click_kernels import descend
from fitter.pose_init.click_problem import (
    FACING_MARGIN_M,
    FACING_SPREAD_M,
    TRUNK_LEAN_SPREAD,
    TRUNK_YAW_SPREAD,
    ClickProblem,
)
from fitter.pose_init.limb_reaches import TRUNCATION

_FIRST_DAMPING = 1e-2
_MOST_DAMPING = 1.0
"""A pose whose steps still fail at this damping has converged."""

_TRACE = 1e-6
"""The root has no prior: this keeps the matrix regular where clicks leave the root undetermined."""

KernelArguments = tuple[tuple, tuple, tuple, tuple, Integer[np.ndarray, " j"]]


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class FittedPoses:
    """A batch of poses, b of them, with their energies."""

    pose: Float[np.ndarray, "b p 3"]
    translation: Float[np.ndarray, "b 3"]
    energy: Float[np.ndarray, " b"]

    def chosen(self, rows: Integer[np.ndarray, " c"]) -> "FittedPoses":
        """The given poses, in this order."""
        return FittedPoses(
            pose=self.pose[rows], translation=self.translation[rows], energy=self.energy[rows]
        )

    def ranked(self) -> "FittedPoses":
        """All poses, best first."""
        return self.chosen(np.argsort(self.energy, kind="stable"))


def fit_clicks(
    problem: ClickProblem,
    pose: Float[np.ndarray, "b p 3"],
    translation: Float[np.ndarray, "b 3"],
    *,
    iterations: int,
    tolerance: float = 1e-3,
) -> FittedPoses:
    """Refine each pose of a batch by damped Gauss-Newton steps.

    A pose stops when a step gains less than ``tolerance`` (in units of energy, half a squared
    standard deviation), or no step lowers the energy.
    """
    pose = np.array(pose, dtype=np.float64, order="C")
    translation = np.array(translation, dtype=np.float64, order="C")
    pixels = np.broadcast_to(problem.pixels, (len(pose), problem.clicked, 2))
    energy = np.empty(len(pose))
    rules = (float(iterations), tolerance, _FIRST_DAMPING, _MOST_DAMPING, _TRACE)
    for row in range(len(pose)):
        rig, prior, clicks, soft, turning = kernel_arguments(problem, pixels[row])
        columns = 3 * len(turning) + (3 if problem.moving else 0)
        energy[row] = descend(
            rig, prior, clicks, soft, turning, columns, pose[row], translation[row], rules
        )
    return FittedPoses(pose=pose, translation=translation, energy=energy)


def kernel_arguments(problem: ClickProblem, pixels: Points2D) -> KernelArguments:
    """A problem in the form the kernels take: plain arrays of fixed types, compiled once."""
    rig, prior, camera = problem.rig, problem.prior, problem.camera
    return (
        (
            _integers(rig.part_parent),
            _floats(rig.rest_joints),
            _floats(rig.weights),
            _floats(rig.arms),
            descendants(rig.part_parent),
        ),
        (
            _floats(prior.axes),
            _floats(prior.mean),
            _floats(prior.precision),
            _floats(prior.lower),
            _floats(prior.upper),
            float(np.radians(LIMIT_SOFTNESS_DEG)),
        ),
        (
            _floats(pixels),
            _floats(problem.precision),
            (float(camera.focal_length_px), float(camera.centre_x), float(camera.centre_y)),
        ),
        (
            _floats(problem.slants),
            FACING_MARGIN_M,
            FACING_SPREAD_M,
            TRUNK_LEAN_SPREAD,
            TRUNK_YAW_SPREAD,
            (
                _floats(problem.hints.rows),
                _floats(problem.hints.toward),
                _floats(problem.hints.reach_m),
                _floats(problem.hints.precision),
                TRUNCATION,
            ),
        ),
        _integers(np.flatnonzero(problem.turning)),
    )


def _floats(array: np.ndarray) -> np.ndarray:
    return np.array(array, dtype=np.float64, order="C")


def _integers(array: np.ndarray) -> np.ndarray:
    return np.array(array, dtype=np.int64, order="C")
