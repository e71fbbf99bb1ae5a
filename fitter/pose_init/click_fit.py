"""Damped Gauss-Newton on clicks, from each of a batch of poses.

Minimises the energy of :mod:`fitter.pose_init.click_problem` by the loop of
:mod:`fitter.numerics.damped_descent`. Rotations are updated as exp(δ) exp(pose), which has no pole.

"Solving for the neck rotation that minimizes the distance between several user-clicked 2D face
feature points and the corresponding 3D vertex positions on the mesh projected into the image." The
neck is two joints here, lower neck and atlas, which share the turn by their priors.
"""

import dataclasses
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Integer

from fitter.body.joint_limits import LIMIT_SOFTNESS_DEG
from fitter.body.pose_prior import mean_pose
from fitter.numerics.damped_descent import FIRST_DAMPING, LARGEST_DAMPING
from fitter.pose_init import _click_kernels as kernels
from fitter.pose_init.click_problem import (
    FACING_MARGIN_M,
    FACING_SPREAD_M,
    TRUNK_LEAN_SPREAD,
    TRUNK_YAW_SPREAD,
    ClickProblem,
)
from fitter.pose_init.landmark_rig import rig_arrays
from fitter.pose_init.limbs import TRUNCATION

FLOOR = 1e-6
"""The root has no prior: this keeps the matrix regular where clicks leave the root undetermined."""


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

    ``iterations`` is how many steps are tried at most. ``tolerance`` is the gain, in units of
    energy (half a squared standard deviation), below which steps end the search of a pose.
    """
    rig, unknowns = rig_arrays(problem.rig), unknowns_of(problem)
    limits = kernels.Limits(iterations, tolerance, FIRST_DAMPING, LARGEST_DAMPING, FLOOR)
    found = [
        kernels.descend(rig, terms, unknowns, each, place, limits)
        for terms, each, place in zip(
            terms_of(problem, len(pose)),
            np.array(pose, dtype=np.float64, order="C"),
            np.array(translation, dtype=np.float64, order="C"),
            strict=True,
        )
    ]
    poses, places, energies = zip(*found, strict=True)
    return FittedPoses(
        pose=np.stack(poses), translation=np.stack(places), energy=np.array(energies)
    )


def unknowns_of(problem: ClickProblem) -> kernels.Unknowns:
    """Unknowns that are solved for."""
    return kernels.Unknowns(np.flatnonzero(problem.turning), problem.moving)


def terms_of(problem: ClickProblem, count: int) -> Iterator[kernels.Terms]:
    """The terms for each pose of a batch, which may have clicks of its own."""
    prior, hints, camera = problem.prior, problem.hints, problem.camera
    rest = (
        kernels.Prior(
            axes=np.ascontiguousarray(prior.axes),
            mean=np.ascontiguousarray(prior.mean),
            precision=np.ascontiguousarray(prior.precision),
            lower=np.ascontiguousarray(prior.lower),
            upper=np.ascontiguousarray(prior.upper),
            softness=float(np.radians(LIMIT_SOFTNESS_DEG)),
        ),
        kernels.Facings(
            rows=np.ascontiguousarray(problem.slants),
            margin=FACING_MARGIN_M,
            spread=FACING_SPREAD_M,
        ),
        kernels.Hints(
            rows=np.ascontiguousarray(hints.rows),
            toward=np.ascontiguousarray(hints.toward),
            reach=np.ascontiguousarray(hints.reach_m),
            precision=np.ascontiguousarray(hints.precision),
            truncation=TRUNCATION,
        ),
        np.array([TRUNK_YAW_SPREAD, TRUNK_LEAN_SPREAD]),
    )
    precision = np.ascontiguousarray(problem.precision)
    seen_by = np.array([camera.focal_length_px, camera.centre_x, camera.centre_y])
    for pixels in np.broadcast_to(problem.pixels, (count, problem.clicked, 2)):
        clicks = kernels.Clicks(np.array(pixels), precision, seen_by)
        yield kernels.Terms(clicks, *rest)


FACE_POINTS = (
    "nose",
    "left_eye",
    "right_eye",
    "left_ear",
    "right_ear",
    "chin",
    "head_top",
)
ENOUGH_FACE_POINTS = 3
"""Fewer points cannot tell a turn from a nod: then the neck keeps the prior's mean."""


def turn_head(
    problem: ClickProblem,
    pose: Float[np.ndarray, "b p 3"],
    translation: Float[np.ndarray, "b 3"],
    *,
    iterations: int = 4,
) -> Float[np.ndarray, "b p 3"]:
    """Turn neck and head toward the face points, with everything else kept.

    Parameters
    ----------
    problem
        The clicks of the whole body.
    pose, translation
        A batch of poses.
    """
    rig = problem.rig
    names = rig.landmark_names[: problem.clicked]
    face = np.array([name in FACE_POINTS for name in names], dtype=bool)
    parts = [rig.part("neck"), rig.part("head")]
    start = pose.copy()
    start[:, parts] = mean_pose(problem.prior)[parts]
    if face.sum() < ENOUGH_FACE_POINTS:
        return start
    turning = np.zeros(len(rig.part_names), dtype=bool)
    turning[parts] = True
    face_problem = dataclasses.replace(
        problem,
        rig=rig.only(tuple(name for name in names if name in FACE_POINTS)),
        clicked=int(face.sum()),
        pixels=problem.pixels[face],
        precision=problem.precision[face],
        slants=np.zeros((0, int(face.sum()))),
        hints=problem.hints.none_of(int(face.sum())),
        turning=turning,
        moving=False,
    )
    return fit_clicks(face_problem, start, translation, iterations=iterations).pose
