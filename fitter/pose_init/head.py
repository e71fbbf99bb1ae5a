"""The neck's rotation from face points (section 3.1).

"Solving for the neck rotation that minimizes the distance between several user-clicked 2D face
feature points and the corresponding 3D vertex positions on the mesh projected into the image." The
neck is two joints here, lower neck and atlas, which share the turn by their priors.
"""

import dataclasses

import numpy as np
from jaxtyping import Float

from fitter.body.pose_prior import mean_pose
from fitter.pose_init.click_fit import fit_clicks
from fitter.pose_init.click_problem import ClickProblem

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
