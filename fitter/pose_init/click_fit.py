"""Gauss-Newton on clicks: a batch of poses at once.

Steps are damped and accepted on the energy, each pose of the batch by itself. Turns are applied as
exp(δ) exp(pose), which has no pole.
"""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float, Integer

from fitter.numerics.rotations import compose
from fitter.pose_init.click_problem import ClickProblem, click_energy, normal_equations
from fitter.pose_init.landmark_rig import PosedLandmarks, pose_landmarks

_FIRST_DAMPING = 1e-2
_MOST_DAMPING = 1.0
"""A pose whose steps fail beyond this damping has arrived."""

_TRACE = 1e-6
"""The root has no prior: keeps the matrix regular where clicks leave it undetermined."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class FittedPoses:
    """A batch of poses, b of them, with their energies."""

    pose: Float[np.ndarray, "b p 3"]
    translation: Float[np.ndarray, "b 3"]
    energy: Float[np.ndarray, " b"]

    def chosen(self, rows: Integer[np.ndarray, " c"]) -> "FittedPoses":
        """Some of them, in this order."""
        return FittedPoses(
            pose=self.pose[rows], translation=self.translation[rows], energy=self.energy[rows]
        )

    def ranked(self) -> "FittedPoses":
        """All of them, best first."""
        return self.chosen(np.argsort(self.energy, kind="stable"))


def fit_clicks(
    problem: ClickProblem,
    pose: Float[np.ndarray, "b p 3"],
    translation: Float[np.ndarray, "b 3"],
    *,
    iterations: int,
    tolerance: float = 1e-3,
) -> FittedPoses:
    """Refine a batch of poses by damped Gauss-Newton steps.

    Stops when no pose of the batch gained more than ``tolerance`` (in units of energy, half a
    squared standard deviation) in its last step.
    """
    posed = pose_landmarks(problem.rig, pose, translation)
    energy = click_energy(problem, pose, posed)
    damping = np.full(len(pose), _FIRST_DAMPING)
    joints = np.flatnonzero(problem.turning)
    for _ in range(iterations):
        equations = normal_equations(problem, pose, posed)
        matrix = equations.matrix
        diagonal = np.einsum("bii->bi", matrix)
        diagonal += damping[:, None] * diagonal + _TRACE
        step = -np.linalg.solve(matrix, equations.gradient[..., None])[..., 0]
        turns = step[:, : 3 * len(joints)].reshape(-1, 3)
        new_pose = pose.copy()
        new_pose[:, joints] = compose(turns, pose[:, joints].reshape(-1, 3)).reshape(
            len(pose), -1, 3
        )
        new_translation = (
            translation + step[:, 3 * len(joints) :] if problem.moving else translation
        )
        new_posed = pose_landmarks(problem.rig, new_pose, new_translation)
        new_energy = click_energy(problem, new_pose, new_posed)
        better = new_energy < energy
        arrived = np.where(better, energy - new_energy < tolerance, damping >= _MOST_DAMPING)
        pose = np.where(better[:, None, None], new_pose, pose)
        translation = np.where(better[:, None], new_translation, translation)
        posed = _chosen(better, new_posed, posed)
        energy = np.where(better, new_energy, energy)
        damping = np.where(better, 0.2 * damping, 10.0 * damping)
        if arrived.all():
            break
    return FittedPoses(pose=pose, translation=translation, energy=energy)


def _chosen(
    better: Bool[np.ndarray, " b"], new: PosedLandmarks, old: PosedLandmarks
) -> PosedLandmarks:
    def choose(a: np.ndarray, b: np.ndarray) -> np.ndarray:
        return np.where(better.reshape(-1, *[1] * (a.ndim - 1)), a, b)

    return PosedLandmarks(
        points=choose(new.points, old.points),
        shares=choose(new.shares, old.shares),
        rotations=choose(new.rotations, old.rotations),
        joints=choose(new.joints, old.joints),
    )
