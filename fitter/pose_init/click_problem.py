"""The clicks as a least-squares problem: its energy and its normal equations.

The energy of a pose is half the sum of squares of

- click residuals, pixels over their standard deviation,
- the pose prior and the joint limits (:mod:`fitter.body.pose_prior`),
- the trunk's slant to the image plane, very softly: pictures of people are mostly taken level,
- a limb's slant against the caller's word, where there is one.

Everything takes a batch of b poses.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float, Integer

from fitter.body.pose_prior import PosePrior, prior_residuals, prior_terms
from fitter.body.skeleton import descendants
from fitter.camera import Camera
from fitter.pose_init.click_spread import click_spreads_m
from fitter.pose_init.landmark_rig import LandmarkRig, PosedLandmarks, landmark_jacobian
from fitter.pose_init.limbs import LIMBS, MIDDLES, limb_slant
from fitter.pose_init.points import ClickedPoints
from fitter.request import Facing

TRUNK_LEAN_SPREAD = 0.35
"""Standard deviation of the trunk's long axis along the view, as a sine (about 20 degrees)."""

TRUNK_YAW_SPREAD = 1.0
"""The same for the axis across the hips: only enough to break ties toward front and back views."""

FACING_MARGIN_M = 0.02
FACING_SPREAD_M = 0.02
"""A limb said to face the camera has its far end at least the margin nearer."""

NEAR_PLANE_M = 0.05


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
        (c, 2) where, or (b, c, 2) for each pose of a batch its own.
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
    pixels: Float[np.ndarray, "... c 2"]
    precision: Float[np.ndarray, " c"]
    slants: Float[np.ndarray, "s k"]
    turning: Bool[np.ndarray, " p"]
    moving: bool


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class NormalEquations:
    """JᵀJ and Jᵀr of all terms; columns are the turning joints' increments, then the place."""

    matrix: Float[np.ndarray, "b columns columns"]
    gradient: Float[np.ndarray, "b columns"]


def click_problem(
    rig: LandmarkRig,
    prior: PosePrior,
    camera: Camera,
    clicks: ClickedPoints,
    *,
    scale: float,
    limb_facing: Mapping[str, Facing],
) -> ClickProblem:
    """The problem of the whole body; ``scale`` is the picture's pixels a metre.

    Joints that move no clicked landmark stay out of it.
    """
    ends = [name for limb in LIMBS for name in (limb.proximal, limb.distal) if name not in MIDDLES]
    corners = [name for pair in MIDDLES.values() for name in pair]
    names = tuple(dict.fromkeys((*clicks.names, *ends, *corners)))
    rig = rig.only(names)
    clicked = np.arange(len(clicks.names))
    slants = [
        (1.0 if limb_facing[limb.name] is Facing.TOWARD else -1.0) * limb_slant(limb, names)
        for limb in LIMBS
        if limb.name in limb_facing
    ]
    follows = rig.weights[clicked] @ descendants(rig.part_parent).T.astype(np.float64)
    return ClickProblem(
        rig=rig,
        prior=prior,
        camera=camera,
        clicked=clicked,
        pixels=clicks.pixels,
        precision=1.0 / (scale * click_spreads_m(clicks.names, clicks.occluded)),
        slants=np.array(slants).reshape(-1, len(names)),
        turning=np.asarray((follows > 1e-3).any(axis=0)),
        moving=True,
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
    in_front = (posed.points[:, problem.clicked, 2] > NEAR_PLANE_M).all(axis=-1)
    return np.where(in_front, energy, np.inf)


def normal_equations(
    problem: ClickProblem, pose: Float[np.ndarray, "b p 3"], posed: PosedLandmarks
) -> NormalEquations:
    """Linearise every term; the prior touches only its own joint's block."""
    joints = np.flatnonzero(problem.turning)
    landmarks = landmark_jacobian(problem.rig, posed, problem.turning)
    b, k = landmarks.shape[:2]
    if problem.moving:
        places = np.broadcast_to(np.eye(3), (b, k, 3, 3))
        landmarks = np.concatenate([landmarks, places], axis=-1)
    columns = landmarks.shape[-1]
    projected = np.matmul(_projection_jacobian(problem, posed), landmarks[:, problem.clicked])
    rows = [projected.reshape(b, -1, columns)]
    residuals = [click_residuals(problem, posed).reshape(b, -1)]
    if len(problem.slants):
        slants = _slant_residuals(problem, posed)
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
    return NormalEquations(matrix=matrix, gradient=gradient)


def click_residuals(problem: ClickProblem, posed: PosedLandmarks) -> Float[np.ndarray, "b c 2"]:
    """Distances from clicks to landmarks in standard deviations."""
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
