"""The fit to clicks in plain numpy, for a batch of poses: what its kernels must agree with."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float

from fitter.body.model import descendants
from fitter.body.pose_prior import prior_residuals, prior_terms
from fitter.body.scape import CAMERA_AXES
from fitter.energies.rows import huber, huber_weights
from fitter.numerics.rotations import rotation_matrices
from fitter.pose_init.click_problem import (
    FACING_MARGIN_M,
    FACING_SPREAD_M,
    TRUNK_LEAN_SPREAD,
    TRUNK_YAW_SPREAD,
    ClickProblem,
)
from fitter.pose_init.landmark_rig import LandmarkRig
from fitter.pose_init.limbs import TRUNCATION


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class PosedLandmarks:
    """Landmarks of a batch of poses.

    Attributes
    ----------
    points
        (..., k, 3) camera frame, metres.
    shares
        (..., k, p, 3) the terms whose sum over parts is a landmark, body frame axes, root joint
        at the origin; they include the rig's ``weights``.
    rotations, joints
        (..., p, 3, 3) and (..., p, 3), body frame axes, root joint at the origin.
    """

    points: Float[np.ndarray, "... k 3"]
    shares: Float[np.ndarray, "... k p 3"]
    rotations: Float[np.ndarray, "... p 3 3"]
    joints: Float[np.ndarray, "... p 3"]


def pose_landmarks(
    rig: LandmarkRig,
    pose: Float[np.ndarray, "... p 3"],
    translation: Float[np.ndarray, "... 3"],
) -> PosedLandmarks:
    """Landmarks in the camera frame for a batch of poses (radians) and root positions (metres)."""
    p = len(rig.part_names)
    local = rotation_matrices(pose.reshape(-1, 3)).reshape(*pose.shape, 3)
    rotations = np.empty_like(local)
    joints = np.zeros_like(pose)
    for part, parent in enumerate(rig.part_parent):
        if parent < 0:
            rotations[..., part, :, :] = local[..., part, :, :]
            continue
        bone = rig.rest_joints[part] - rig.rest_joints[parent]
        rotations[..., part, :, :] = rotations[..., parent, :, :] @ local[..., part, :, :]
        joints[..., part, :] = joints[..., parent, :] + rotations[..., parent, :, :] @ bone
    # (..., p, k, 3) = arms (p, k, 3) times transposed rotations (..., p, 3, 3).
    shares = np.matmul(rig.arms.transpose(1, 0, 2), np.swapaxes(rotations, -1, -2))
    shares = shares + rig.weights.T[:, :, None] * joints[..., :, None, :]
    points = shares.sum(axis=-3) * CAMERA_AXES + translation[..., None, :]
    return PosedLandmarks(
        points=points,
        shares=shares.reshape(*pose.shape[:-2], p, -1, 3).swapaxes(-3, -2),
        rotations=rotations,
        joints=joints,
    )


def click_energy(
    problem: ClickProblem, pose: Float[np.ndarray, "b p 3"], posed: PosedLandmarks
) -> Float[np.ndarray, " b"]:
    """Half the sum of squares; infinite where a clicked landmark lies behind the camera."""
    clicks = click_residuals(problem, posed)
    prior = prior_residuals(problem.prior, pose)
    energy = 0.5 * (
        (clicks**2).sum(axis=(-2, -1))
        + (prior**2).sum(axis=(-2, -1))
        + (_slant_residuals(problem, posed) ** 2).sum(axis=-1)
        + (_trunk_residuals(posed) ** 2).sum(axis=-1)
    )
    energy += huber(_hint_residuals(problem, posed), TRUNCATION).sum(axis=-1)
    in_front = (posed.points[:, : problem.clicked, 2] > 0.05).all(axis=-1)
    return np.where(in_front, energy, np.inf)


def normal_equations(
    problem: ClickProblem, pose: Float[np.ndarray, "b p 3"], posed: PosedLandmarks
) -> tuple[np.ndarray, np.ndarray]:
    """Linearise every term; the prior touches only its own joint's block."""
    joints = np.flatnonzero(problem.turning)
    landmarks = landmark_jacobian(problem.rig, posed, problem.turning)
    b, k = landmarks.shape[:2]
    if problem.moving:
        places = np.broadcast_to(np.eye(3), (b, k, 3, 3))
        landmarks = np.concatenate([landmarks, places], axis=-1)
    columns = landmarks.shape[-1]
    projected = np.matmul(_projection_jacobian(problem, posed), landmarks[:, : problem.clicked])
    rows = [projected.reshape(b, -1, columns)]
    residuals = [click_residuals(problem, posed).reshape(b, -1)]
    if len(problem.slants):
        slants = _slant_residuals(problem, posed)
        slope = (slants > 0.0) / FACING_SPREAD_M
        rows.append(slope[..., None] * np.matmul(problem.slants, landmarks[:, :, 2]))
        residuals.append(slants)
    if len(problem.hints.rows):
        hints = _hint_residuals(problem, posed)
        share = np.sqrt(huber_weights(hints, TRUNCATION))
        along = np.einsum("hk,bkrc,r->bhc", problem.hints.rows, landmarks, problem.hints.toward)
        rows.append((share * problem.hints.precision)[..., None] * along)
        residuals.append(share * hints)
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
    return matrix, gradient


def click_residuals(problem: ClickProblem, posed: PosedLandmarks) -> Float[np.ndarray, "b c 2"]:
    """Distances from clicks to landmarks in standard deviations."""
    seen = problem.camera.project(posed.points[:, : problem.clicked])
    return problem.precision[:, None] * (seen - problem.pixels)


def _projection_jacobian(
    problem: ClickProblem, posed: PosedLandmarks
) -> Float[np.ndarray, "b c 2 3"]:
    points = posed.points[:, : problem.clicked]
    inverse = 1.0 / points[..., 2]
    scale = problem.camera.focal_length_px * inverse * problem.precision
    result = np.zeros((*points.shape[:2], 2, 3))
    result[..., 0, 0] = result[..., 1, 1] = scale
    result[..., :, 2] = -(scale * inverse)[..., None] * points[..., :2]
    return result


def _slant_residuals(problem: ClickProblem, posed: PosedLandmarks) -> Float[np.ndarray, "b s"]:
    slant = posed.points[..., 2] @ problem.slants.T
    return np.maximum(slant + FACING_MARGIN_M, 0.0) / FACING_SPREAD_M


def _hint_residuals(problem: ClickProblem, posed: PosedLandmarks) -> Float[np.ndarray, "b h"]:
    hints = problem.hints
    reach = np.einsum("hk,bkr,r->bh", hints.rows, posed.points, hints.toward)
    return hints.precision * (reach - hints.reach_m)


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


def landmark_jacobian(
    rig: LandmarkRig, posed: PosedLandmarks, turning: Bool[np.ndarray, " p"]
) -> Float[np.ndarray, "... k 3 columns"]:
    """Derivative of camera-frame landmarks by increments of the turning joints.

    Three columns a turning joint, for increments δ applied as exp(δ) exp(pose): the axes are those
    of the parent part, and a turn moves a landmark by axis × (its share beyond the joint).
    """
    joints = np.flatnonzero(turning)
    follows = descendants(rig.part_parent)[joints].astype(np.float64)
    beyond = np.matmul(follows, posed.shares)
    share = rig.weights @ follows.T
    beyond -= share[:, :, None] * posed.joints[..., None, joints, :]
    parents = rig.part_parent[joints]
    axes = posed.rotations[..., np.maximum(parents, 0), :, :].copy()
    axes[..., parents < 0, :, :] = np.eye(3)
    # d = axis × beyond = -[beyond]× axis, all three axes of a joint at once.
    moved = np.matmul(_minus_cross_matrices(beyond), axes[..., None, :, :, :])
    moved *= CAMERA_AXES[:, None]
    ordered = np.swapaxes(moved, -3, -2)
    return ordered.reshape(*ordered.shape[:-2], 3 * len(joints))


def _minus_cross_matrices(vectors: Float[np.ndarray, "... 3"]) -> Float[np.ndarray, "... 3 3"]:
    """Matrices M with M a = a × v."""
    matrices = np.zeros((*vectors.shape, 3))
    x, y, z = vectors[..., 0], vectors[..., 1], vectors[..., 2]
    matrices[..., 0, 1], matrices[..., 0, 2] = z, -y
    matrices[..., 1, 0], matrices[..., 1, 2] = -z, x
    matrices[..., 2, 0], matrices[..., 2, 1] = y, -x
    return matrices
