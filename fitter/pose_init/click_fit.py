"""Gauss-Newton on clicks: many poses at once, under the pose prior.

Minimises, over joint turns and the root's place, half the sum of squares of

- click residuals, pixels over their standard deviation,
- the pose prior and the joint limits (:mod:`fitter.body.pose_prior`),
- the trunk's slant to the image plane, very softly: pictures of people are mostly taken level,
- a limb's slant against the caller's word, where there is one.

Joints that move no clicked landmark stay where they are. Steps are damped and accepted on the
energy, each pose of the batch by itself.
"""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float, Integer

from fitter.body.pose_prior import PosePrior, prior_terms
from fitter.body.skeleton import descendants
from fitter.camera import Camera
from fitter.numerics.rotations import compose
from fitter.pose_init.landmark_rig import (
    LandmarkRig,
    PosedLandmarks,
    landmark_jacobian,
    pose_landmarks,
)

TRUNK_LEAN_SPREAD = 0.35
"""Standard deviation of the trunk's long axis along the view, as a sine (about 20 degrees)."""

TRUNK_YAW_SPREAD = 1.0
"""The same for the axis across the hips: only enough to break ties toward front and back views."""

FACING_MARGIN_M = 0.02
FACING_SPREAD_M = 0.02
"""A limb said to face the camera has its far end at least the margin nearer."""

_FIRST_DAMPING = 1e-2
_NEAR_PLANE_M = 0.05


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class ClickProblem:
    """What to fit.

    Attributes
    ----------
    rig
        The person, with the landmarks used below in its own order.
    prior
        The pose prior in the rig's rest pose.
    camera
        The camera.
    clicked
        (c,) rig landmarks that were clicked.
    pixels
        (c, 2) where.
    precision
        (c,) one over the standard deviation, 1/pixels.
    slants
        (s, k) rows over the rig's landmarks: far end minus near end of each limb the caller spoke
        about, times -1 where it faces away; the slant's depth should be negative.
    turning
        (p,) joints to solve for.
    moving
        Whether the root's place is solved for.
    """

    rig: LandmarkRig
    prior: PosePrior
    camera: Camera
    clicked: Integer[np.ndarray, " c"]
    pixels: Float[np.ndarray, "c 2"]
    precision: Float[np.ndarray, " c"]
    slants: Float[np.ndarray, "s k"]
    turning: Bool[np.ndarray, " p"]
    moving: bool


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


def moved_joints(rig: LandmarkRig, landmarks: Integer[np.ndarray, " c"]) -> Bool[np.ndarray, " p"]:
    """Joints that move at least one of the landmarks."""
    follows = rig.weights[landmarks] @ descendants(rig.part_parent).T.astype(np.float64)
    return np.asarray((follows > 1e-3).any(axis=0))


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
        matrix, gradient = normal_equations(problem, pose, posed)
        diagonal = np.einsum("bii->bi", matrix)
        diagonal += damping[:, None] * diagonal
        step = -np.linalg.solve(matrix, gradient[..., None])[..., 0]
        turned = np.zeros_like(pose)
        turned[:, joints] = step[:, : 3 * len(joints)].reshape(len(pose), -1, 3)
        new_pose = compose(turned.reshape(-1, 3), pose.reshape(-1, 3)).reshape(pose.shape)
        new_translation = (
            translation + step[:, 3 * len(joints) :] if problem.moving else translation
        )
        new_posed = pose_landmarks(problem.rig, new_pose, new_translation)
        new_energy = click_energy(problem, new_pose, new_posed)
        better = new_energy < energy
        gain = np.where(better, energy - new_energy, 0.0)
        pose = np.where(better[:, None, None], new_pose, pose)
        translation = np.where(better[:, None], new_translation, translation)
        posed = _chosen(better, new_posed, posed)
        energy = np.where(better, new_energy, energy)
        damping = np.where(better, 0.2 * damping, 10.0 * damping)
        if (gain < tolerance).all() and (better | (damping > 1.0)).all():
            break
    return FittedPoses(pose=pose, translation=translation, energy=energy)


def click_energy(
    problem: ClickProblem, pose: Float[np.ndarray, "b p 3"], posed: PosedLandmarks
) -> Float[np.ndarray, " b"]:
    """Half the sum of squares; infinite where a clicked landmark lies behind the camera."""
    clicks = _click_residuals(problem, posed)
    prior = prior_terms(problem.prior, pose).residuals
    energy = 0.5 * (
        (clicks**2).sum(axis=(-2, -1))
        + (prior**2).sum(axis=(-2, -1))
        + (_slant_residuals(problem, posed) ** 2).sum(axis=-1)
        + (_trunk_residuals(posed) ** 2).sum(axis=-1)
    )
    in_front = (posed.points[:, problem.clicked, 2] > _NEAR_PLANE_M).all(axis=-1)
    return np.where(in_front, energy, np.inf)


def normal_equations(
    problem: ClickProblem, pose: Float[np.ndarray, "b p 3"], posed: PosedLandmarks
) -> tuple[Float[np.ndarray, "b columns columns"], Float[np.ndarray, "b columns"]]:
    """JᵀJ and Jᵀr of all terms; columns are the turning joints' increments, then the place."""
    joints = np.flatnonzero(problem.turning)
    turns = landmark_jacobian(problem.rig, posed, problem.turning)
    b, k = turns.shape[:2]
    if problem.moving:
        places = np.broadcast_to(np.eye(3), (b, k, 3, 3))
        landmarks = np.concatenate([turns, places], axis=-1)
    else:
        landmarks = turns
    columns = landmarks.shape[-1]
    rows = [
        np.matmul(_projection_jacobian(problem, posed), landmarks[:, problem.clicked]).reshape(
            b, -1, columns
        )
    ]
    residuals = [_click_residuals(problem, posed).reshape(b, -1)]
    slants = _slant_residuals(problem, posed)
    if slants.shape[1]:
        slope = (slants > 0.0) / FACING_SPREAD_M
        rows.append(slope[..., None] * np.matmul(problem.slants, landmarks[:, :, 2]))
        residuals.append(slants)
    if problem.turning[0]:
        trunk = np.zeros((b, 2, columns))
        trunk[:, :, :3] = _trunk_jacobian(posed)
        rows.append(trunk)
        residuals.append(_trunk_residuals(posed))
    jacobian, residual = np.concatenate(rows, axis=1), np.concatenate(residuals, axis=1)
    transposed = np.swapaxes(jacobian, 1, 2)
    matrix = np.matmul(transposed, jacobian)
    gradient = np.matmul(transposed, residual[..., None])[..., 0]
    terms = prior_terms(problem.prior, pose)
    blocks = np.swapaxes(terms.jacobian[:, joints], -1, -2)
    square = np.matmul(blocks, terms.jacobian[:, joints])
    pull = np.matmul(blocks, terms.residuals[:, joints, :, None])[..., 0]
    for index in range(len(joints)):
        own = slice(3 * index, 3 * index + 3)
        matrix[:, own, own] += square[:, index]
    gradient[:, : 3 * len(joints)] += pull.reshape(b, -1)
    # The root has no prior: a trace keeps the matrix regular when clicks leave it undetermined.
    np.einsum("bii->bi", matrix)[...] += 1e-6
    return matrix, gradient


def _click_residuals(problem: ClickProblem, posed: PosedLandmarks) -> Float[np.ndarray, "b c 2"]:
    seen = problem.camera.project(posed.points[:, problem.clicked])
    return problem.precision[:, None] * (seen - problem.pixels)


def _projection_jacobian(
    problem: ClickProblem, posed: PosedLandmarks
) -> Float[np.ndarray, "b c 2 3"]:
    points = posed.points[:, problem.clicked]
    inverse = 1.0 / points[..., 2]
    scale = problem.camera.focal_length_px * inverse * problem.precision
    result = np.zeros((*points.shape[:2], 2, 3))
    result[..., 0, 0] = result[..., 1, 1] = scale
    result[..., :, 2] = -(scale * inverse)[..., None] * points[..., :2]
    return result


def _slant_residuals(problem: ClickProblem, posed: PosedLandmarks) -> Float[np.ndarray, "b s"]:
    slant = posed.points[..., 2] @ problem.slants.T
    return np.maximum(slant + FACING_MARGIN_M, 0.0) / FACING_SPREAD_M


def _trunk_residuals(posed: PosedLandmarks) -> Float[np.ndarray, "b 2"]:
    root = posed.rotations[..., 0, :, :]
    return np.stack(
        [root[..., 2, 1] / TRUNK_LEAN_SPREAD, root[..., 2, 0] / TRUNK_YAW_SPREAD], axis=-1
    )


def _trunk_jacobian(posed: PosedLandmarks) -> Float[np.ndarray, "b 2 3"]:
    """d(R e) = δ × R e, of which the z part is δx (R e)_y - δy (R e)_x."""
    root = posed.rotations[..., 0, :, :]
    result = np.zeros((*root.shape[:-2], 2, 3))
    for row, (axis, spread) in enumerate(((1, TRUNK_LEAN_SPREAD), (0, TRUNK_YAW_SPREAD))):
        result[..., row, 0] = root[..., 1, axis] / spread
        result[..., row, 1] = -root[..., 0, axis] / spread
    return result


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
