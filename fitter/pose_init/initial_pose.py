"""Pose from clicks (section 3.1): from closed-form readings to a few refined, ranked hypotheses.

1. Predict limb lengths from the height-constrained mean person.
2. Take the root's depth from the limb most parallel to the image.
3. Lift the limbs by Lee and Chen in every way that the image and the caller allow, turn the lifted
   points into joint angles, rank by joint limits and prior.
4. Turn the head toward the face points.
5. Refine the best by Gauss-Newton on the clicks, first on blended landmarks, then with the small
   difference to the SCAPE surface's own landmarks taken into account.

The best hypothesis is the pose; the others are returned with their energies, because the picture
may resolve what clicks cannot.
"""

import dataclasses
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from fitter.arrays import Shape
from fitter.body.model import regress
from fitter.body.pose_prior import pose_prior
from fitter.body.scape import ScapeEvaluator
from fitter.detection.detector import DetectedSlants
from fitter.errors import InvalidInputError
from fitter.parameters import BodyParameters
from fitter.pose_init.click_fit import FittedPoses, fit_clicks, turn_head
from fitter.pose_init.click_problem import ClickedPoints, ClickProblem, click_problem
from fitter.pose_init.landmark_rig import LandmarkRig, landmark_points, landmark_rig
from fitter.pose_init.lifting import Lifting, PerspectiveLifting
from fitter.pose_init.limbs import (
    LIMBS,
    TORSO,
    ReferenceLimb,
    landmarks_of,
    limb_lengths_m,
    limb_slant,
    reference_limb,
)
from fitter.pose_init.start_poses import start_poses
from fitter.pose_init.trunk import TrunkPoints, trunk_points
from fitter.render.camera import Camera
from fitter.vocabulary.choices import Facing

_SETTLING_ITERATIONS = 3

_NEAREST_M = 0.1
"""Least depth of a landmark: nearer to the camera, or behind it, it has no place in a picture."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class PoseHypothesis:
    """One reading of the clicks.

    Attributes
    ----------
    parameters
        The body.
    energy
        Half a sum of squares: clicks, prior, limits. A difference of 2 is about two standard
        deviations.
    facing
        By limb name: which way the limb faces here.
    """

    parameters: BodyParameters
    energy: float
    facing: Mapping[str, Facing]


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class InitialPose:
    """The pose that starts the fit.

    Attributes
    ----------
    parameters
        The best hypothesis' body.
    hypotheses
        All of them, best first, at most :data:`~fitter.pose_init.initial_pose.MOST_HYPOTHESES`.
    reference_limb
        The limb taken as most parallel to the image.
    root_depth_m
        Depth of the root joint in the best hypothesis.
    residual_px
        Distance from each click to the body's landmark, by name.
    """

    parameters: BodyParameters
    hypotheses: tuple[PoseHypothesis, ...]
    reference_limb: str
    root_depth_m: float
    residual_px: Mapping[str, float]


def initialize_pose(
    evaluator: ScapeEvaluator,
    *,
    camera: Camera,
    clicks: ClickedPoints,
    shape: Shape,
    limb_facing: Mapping[str, Facing],
    slants: DetectedSlants | None = None,
) -> InitialPose:
    """Find the pose of a person of known shape from clicked points.

    Parameters
    ----------
    evaluator
        The body model of the person's gender.
    camera
        The camera of the picture that was clicked in.
    clicks
        Clicked landmarks; names the model does not know are a programming error and raise
        ``ValueError``.
    shape
        The mean person of the height (:func:`fitter.body.shape_space.shape_for_height`).
    limb_facing
        Which way limbs face according to the caller, by limb name; always obeyed.
    slants
        How limbs slant according to the detector; a hint.

    Raises
    ------
    InvalidInputError
        Where too little of the trunk was clicked to place it, and where the points can only be
        those of a body behind the camera.
    """
    model = evaluator.model
    rig = landmark_rig(model, shape)
    prior = pose_prior(rig.part_names, rig.part_parent, rig.rest_joints)
    lengths = limb_lengths_m(rig)
    trunk = trunk_points(clicks, lengths)
    reference = reference_of(clicks, trunk, lengths)
    problem = click_problem(
        rig, prior, camera, clicks, scale=reference.scale, limb_facing=limb_facing, slants=slants
    )
    fitted = refined_hypotheses(
        problem,
        PerspectiveLifting(camera=camera),
        pixels={**clicks.by_name(), **trunk.pixels},
        lengths_m=lengths,
        reference=reference,
        limb_facing=limb_facing,
    )
    fitted = _in_front(problem.rig, fitted)
    fitted = _in_front(problem.rig, _on_the_surface(evaluator, problem, shape, fitted))
    hypotheses = _described(problem.rig, shape, fitted)
    best = hypotheses[0].parameters
    seen = camera.project(_surface_landmarks(evaluator, best, clicks.names))
    distances = np.linalg.norm(seen - clicks.pixels, axis=1)
    return InitialPose(
        parameters=best,
        hypotheses=hypotheses,
        reference_limb=reference.limb.name,
        root_depth_m=float(best.translation[2]),
        residual_px=dict(zip(clicks.names, distances.tolist(), strict=True)),
    )


def reference_of(
    clicks: ClickedPoints, trunk: TrunkPoints, lengths_m: Mapping[str, float]
) -> ReferenceLimb:
    """The reference limb among those seen in full; without any, the torso, even if guessed."""
    pixels = {**clicks.by_name(), **trunk.pixels}
    seen = [
        limb.name
        for limb in LIMBS
        if limb.proximal in pixels
        and limb.distal in pixels
        and not trunk.guessed & {*landmarks_of(limb.proximal), *landmarks_of(limb.distal)}
    ]
    return reference_limb(pixels, lengths_m, candidates=seen or [TORSO])


def _surface_landmarks(
    evaluator: ScapeEvaluator, parameters: BodyParameters, names: tuple[str, ...]
) -> Float[np.ndarray, "k 3"]:
    rows = [evaluator.model.landmarks.names.index(name) for name in names]
    return regress(evaluator.model.landmarks, evaluator.vertices(parameters))[rows]


def _on_the_surface(
    evaluator: ScapeEvaluator, problem: ClickProblem, shape: Shape, fitted: FittedPoses
) -> FittedPoses:
    """Shift each click by the difference of blended and true landmarks, and refine again."""
    names = problem.rig.landmark_names[: problem.clicked]
    surface = np.stack(
        [
            _surface_landmarks(
                evaluator,
                BodyParameters(pose=pose, translation=translation, shape=shape),
                names,
            )
            for pose, translation in zip(fitted.pose, fitted.translation, strict=True)
        ]
    )
    blended = landmark_points(problem.rig, fitted.pose, fitted.translation)
    shift = problem.camera.project(blended[:, : problem.clicked]) - problem.camera.project(surface)
    shifted = dataclasses.replace(problem, pixels=problem.pixels + shift)
    settled = fit_clicks(shifted, fitted.pose, fitted.translation, iterations=_SETTLING_ITERATIONS)
    return distinct_hypotheses(settled)


def _in_front(rig: LandmarkRig, fitted: FittedPoses) -> FittedPoses:
    """The poses in front of the camera; absurd points may be met best by a body behind it."""
    landmarks = landmark_points(rig, fitted.pose, fitted.translation)
    rows = np.flatnonzero(landmarks[:, :, 2].min(axis=1) > _NEAREST_M)
    if not len(rows):
        raise InvalidInputError(
            code="person-not-found",
            field="points",
            reason="No person in front of the camera has points like these.",
            remedy="Check that every point has the name of the landmark that it lies on.",
        )
    return fitted.chosen(rows)


def _described(rig: LandmarkRig, shape: Shape, fitted: FittedPoses) -> tuple[PoseHypothesis, ...]:
    return tuple(
        PoseHypothesis(
            parameters=BodyParameters(pose=pose, translation=translation, shape=shape.copy()),
            energy=float(energy),
            facing=facing,
        )
        for pose, translation, energy, facing in zip(
            fitted.pose,
            fitted.translation,
            fitted.energy,
            limb_facings(rig, fitted),
            strict=True,
        )
    )


STARTS = 16
"""At most this many closed-form readings are refined."""

MOST_HYPOTHESES = 8
"""At most this many hypotheses are refined fully and returned."""

_ROUGH_ITERATIONS, _FINE_ITERATIONS = 5, 20

HOPELESS_ENERGY = 25.0
"""Hypotheses this much above the best are dropped: a likelihood of e to the -25 is no alternative,
and a limb bent far beyond its limits would only cost time until the picture's evidence rejects it.
"""

_SAME_BASIN = np.radians(12.0)
"""Roughly refined poses whose joints all agree this closely would converge to the same pose."""

_CLEAR_SLANT = 0.15
"""Difference of two slants that matters, as a share of the limb's length (about 9 degrees)."""

_SAME_POSE = np.radians(6.0)
"""Refined poses whose joints all agree this closely are one hypothesis."""


def refined_hypotheses(
    problem: ClickProblem,
    lifting: Lifting,
    *,
    pixels: Mapping[str, Float[np.ndarray, "2"]],
    lengths_m: Mapping[str, float],
    reference: ReferenceLimb,
    limb_facing: Mapping[str, Facing],
) -> FittedPoses:
    """Closed-form starts, head, and refinement on blended landmarks; best first."""
    starts = start_poses(
        problem.rig,
        problem.prior,
        lifting,
        pixels,
        lengths_m,
        reference.limb,
        limb_facing=limb_facing,
        count=STARTS,
    )
    pose = turn_head(problem, starts.pose, starts.translation)
    rough = fit_clicks(problem, pose, starts.translation, iterations=_ROUGH_ITERATIONS).ranked()
    kept = _distinct(rough, _SAME_BASIN, most=MOST_HYPOTHESES)
    fine = fit_clicks(problem, kept.pose, kept.translation, iterations=_FINE_ITERATIONS)
    return distinct_hypotheses(fine)


def distinct_hypotheses(fitted: FittedPoses) -> FittedPoses:
    """Best first, without poses that converged to a better one's or are hopelessly worse."""
    return _distinct(fitted.ranked(), _SAME_POSE, most=len(fitted.pose))


def limb_facings(rig: LandmarkRig, fitted: FittedPoses) -> list[dict[str, Facing]]:
    """Facing of every limb of every pose.

    A limb nearly parallel to the image may come out a degree to either side in two poses that are
    really the same reading. So a pose differs from the first only in limbs whose slant clearly
    differs.
    """
    points = landmark_points(rig, fitted.pose, fitted.translation)
    result: list[dict[str, Facing]] = [{} for _ in points]
    for limb in LIMBS:
        row = limb_slant(limb, rig.landmark_names)
        length = float(np.linalg.norm(row @ rig.rest_landmarks))
        slants = points[..., 2] @ row
        clear = np.abs(slants - slants[0]) > _CLEAR_SLANT * length
        for facing, slant in zip(result, np.where(clear, slants, slants[0]), strict=True):
            facing[limb.name] = Facing.TOWARD if slant < 0.0 else Facing.AWAY
    return result


def _distinct(fitted: FittedPoses, angle: float, *, most: int) -> FittedPoses:
    kept: list[int] = []
    for row, pose in enumerate(fitted.pose):
        if len(kept) == most or fitted.energy[row] > fitted.energy[0] + HOPELESS_ENERGY:
            break
        if all(np.abs(pose - fitted.pose[other]).max() > angle for other in kept):
            kept.append(row)
    return fitted.chosen(np.array(kept))
