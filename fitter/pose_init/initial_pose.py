"""Pose from clicks (section 3.1): from closed form to a few refined, ranked hypotheses.

1. Predict limb lengths from the height-constrained mean person.
2. Take the root's depth from the limb most parallel to the image.
3. Lift the limbs by Lee and Chen in every way the image and the caller's word allow, turn lifted
   points into joint angles, rank by joint limits and prior.
4. Turn the head toward the face points.
5. Refine the best by Gauss-Newton on the clicks, first on blended landmarks, then with the small
   difference to the SCAPE surface's own landmarks taken into account.

The best hypothesis is the pose; the others are returned with their energies, because what clicks
cannot tell the picture may.
"""

import dataclasses
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from fitter.arrays import Shape
from fitter.body.pose_prior import PosePrior, pose_prior
from fitter.body.scape import ScapeEvaluator
from fitter.body.skeleton import regress
from fitter.camera import Camera
from fitter.parameters import BodyParameters
from fitter.pose_init.click_fit import ClickProblem, FittedPoses, fit_clicks, moved_joints
from fitter.pose_init.head import turn_head
from fitter.pose_init.hypotheses import start_poses
from fitter.pose_init.landmark_rig import LandmarkRig, landmark_rig, pose_landmarks
from fitter.pose_init.lifting import Lifting
from fitter.pose_init.limbs import LIMBS, MIDDLES, limb_lengths_m
from fitter.pose_init.perspective import PerspectiveLifting
from fitter.pose_init.points import ClickedPoints
from fitter.pose_init.reference_limb import CLICK_SPREAD_M, ReferenceLimb, reference_limb
from fitter.pose_init.trunk_points import TrunkPoints, trunk_points
from fitter.request import Facing

STARTS = 16
"""Closed-form readings that are refined at all."""

MOST_HYPOTHESES = 8
"""Hypotheses refined to the end and returned at most."""

OCCLUDED_SPREAD = 3.0
"""How much less a hidden point's click is believed."""

_SAME_ANGLE = np.radians(6.0)
"""Refined poses whose joints all agree this closely are one hypothesis."""


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
    flipped
        Limbs that face the other way than in the best hypothesis.
    """

    parameters: BodyParameters
    energy: float
    facing: Mapping[str, Facing]
    flipped: tuple[str, ...]


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class InitialPose:
    """The pose that starts the fit.

    Attributes
    ----------
    parameters
        The best hypothesis' body.
    hypotheses
        All, best first, at most :data:`MOST_HYPOTHESES`.
    reference_limb
        The limb taken as most parallel to the image.
    root_depth_m
        Depth of the root joint in the best hypothesis.
    residual_px
        By click name: distance from the click to the body's landmark.
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
) -> InitialPose:
    """Find the pose of a person of known shape from clicked points.

    Parameters
    ----------
    evaluator
        The body model of the person's gender.
    camera
        The camera of the picture that was clicked in.
    clicks
        Clicked landmarks; names the model does not know are an error of the caller of this
        function and raise ``ValueError``.
    shape
        The mean person of the height (:func:`fitter.body.stature.shape_for_height`).
    limb_facing
        The caller's word, by limb name; obeyed.

    Raises
    ------
    InvalidInputError
        Where too little of the trunk was clicked to place it.
    """
    model = evaluator.model
    rig = landmark_rig(model, shape)
    prior = pose_prior(rig.part_names, rig.part_parent, rig.rest_joints)
    lengths = limb_lengths_m(rig)
    trunk = trunk_points(clicks, lengths)
    reference = reference_of(clicks, trunk, lengths)
    problem = click_problem(
        rig, prior, camera, clicks, scale=reference.scale, limb_facing=limb_facing
    )
    fitted = refined_hypotheses(
        problem,
        PerspectiveLifting(camera=camera),
        pixels={**clicks.by_name(), **trunk.pixels},
        lengths_m=lengths,
        reference=reference,
        limb_facing=limb_facing,
    )
    fitted = _on_the_surface(evaluator, problem, shape, fitted)
    fitted = _distinct(fitted)
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


def click_problem(
    rig: LandmarkRig,
    prior: PosePrior,
    camera: Camera,
    clicks: ClickedPoints,
    *,
    scale: float,
    limb_facing: Mapping[str, Facing],
) -> ClickProblem:
    """The clicks as a least-squares problem; ``scale`` is the picture's pixels a metre."""
    ends = [name for limb in LIMBS for name in (limb.proximal, limb.distal) if name not in MIDDLES]
    corners = [name for pair in MIDDLES.values() for name in pair]
    names = tuple(dict.fromkeys((*clicks.names, *ends, *corners)))
    rig = rig.only(names)
    clicked = np.arange(len(clicks.names))
    spread = CLICK_SPREAD_M * scale * np.where(clicks.occluded, OCCLUDED_SPREAD, 1.0)
    slants = [
        (1.0 if limb_facing[limb.name] is Facing.TOWARD else -1.0)
        * (_end_row(names, limb.distal) - _end_row(names, limb.proximal))
        for limb in LIMBS
        if limb.name in limb_facing
    ]
    return ClickProblem(
        rig=rig,
        prior=prior,
        camera=camera,
        clicked=clicked,
        pixels=clicks.pixels,
        precision=1.0 / spread,
        slants=np.array(slants).reshape(-1, len(names)),
        turning=moved_joints(rig, clicked),
        moving=True,
    )


def refined_hypotheses(
    problem: ClickProblem,
    lifting: Lifting,
    *,
    pixels: Mapping[str, Float[np.ndarray, "2"]],
    lengths_m: Mapping[str, float],
    reference: ReferenceLimb,
    limb_facing: Mapping[str, Facing],
) -> FittedPoses:
    """Closed form, head, and refinement on blended landmarks; best first."""
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
    rough = fit_clicks(problem, pose, starts.translation, iterations=5)
    kept = rough.chosen(np.argsort(rough.energy, kind="stable")[:MOST_HYPOTHESES])
    fitted = fit_clicks(problem, kept.pose, kept.translation, iterations=20)
    return fitted.chosen(np.argsort(fitted.energy, kind="stable"))


def reference_of(
    clicks: ClickedPoints, trunk: TrunkPoints, lengths_m: Mapping[str, float]
) -> ReferenceLimb:
    """Among limbs seen in full; the torso, even guessed, where there is none."""
    pixels = {**clicks.by_name(), **trunk.pixels}
    seen = [
        limb.name
        for limb in LIMBS
        if limb.proximal in pixels
        and limb.distal in pixels
        and not trunk.guessed & {*_corners(limb.proximal), *_corners(limb.distal)}
    ]
    return reference_limb(pixels, lengths_m, candidates=seen or ["torso"])


def _corners(point: str) -> tuple[str, ...]:
    return MIDDLES.get(point, (point,))


def _end_row(names: tuple[str, ...], point: str) -> Float[np.ndarray, " k"]:
    corners = _corners(point)
    return np.array([1.0 / len(corners) if name in corners else 0.0 for name in names])


def _surface_landmarks(
    evaluator: ScapeEvaluator, parameters: BodyParameters, names: tuple[str, ...]
) -> Float[np.ndarray, "k 3"]:
    rows = [evaluator.model.landmarks.names.index(name) for name in names]
    return regress(evaluator.model.landmarks, evaluator.vertices(parameters))[rows]


def _on_the_surface(
    evaluator: ScapeEvaluator, problem: ClickProblem, shape: Shape, fitted: FittedPoses
) -> FittedPoses:
    """Shift each click by how far blended and true landmarks lie apart, and settle."""
    names = tuple(problem.rig.landmark_names[i] for i in problem.clicked)
    settled: list[FittedPoses] = []
    for pose, translation in zip(fitted.pose, fitted.translation, strict=True):
        parameters = BodyParameters(pose=pose, translation=translation, shape=shape)
        true = problem.camera.project(_surface_landmarks(evaluator, parameters, names))
        blended = problem.camera.project(
            pose_landmarks(problem.rig, pose, translation).points[problem.clicked]
        )
        shifted = dataclasses.replace(problem, pixels=problem.pixels - true + blended)
        settled.append(fit_clicks(shifted, pose[None], translation[None], iterations=3))
    energy = np.concatenate([one.energy for one in settled])
    order = np.argsort(energy, kind="stable")
    return FittedPoses(
        pose=np.concatenate([one.pose for one in settled]),
        translation=np.concatenate([one.translation for one in settled]),
        energy=energy,
    ).chosen(order)


def _distinct(fitted: FittedPoses) -> FittedPoses:
    """Drop poses that came out the same as a better one."""
    kept: list[int] = []
    for row, pose in enumerate(fitted.pose):
        if all(np.abs(pose - fitted.pose[other]).max() > _SAME_ANGLE for other in kept):
            kept.append(row)
    return fitted.chosen(np.array(kept))


def _described(rig: LandmarkRig, shape: Shape, fitted: FittedPoses) -> tuple[PoseHypothesis, ...]:
    facings = limb_facings(rig, fitted)
    return tuple(
        PoseHypothesis(
            parameters=BodyParameters(pose=pose, translation=translation, shape=shape.copy()),
            energy=float(energy),
            facing=facing,
            flipped=tuple(name for name in facing if facing[name] is not facings[0][name]),
        )
        for pose, translation, energy, facing in zip(
            fitted.pose, fitted.translation, fitted.energy, facings, strict=True
        )
    )


def limb_facings(rig: LandmarkRig, fitted: FittedPoses) -> list[dict[str, Facing]]:
    """Which way every limb of every pose faces."""
    points = pose_landmarks(rig, fitted.pose, fitted.translation).points
    result: list[dict[str, Facing]] = [{} for _ in points]
    for limb in LIMBS:
        row = _end_row(rig.landmark_names, limb.distal) - _end_row(
            rig.landmark_names, limb.proximal
        )
        for facing, slant in zip(result, points[..., 2] @ row, strict=True):
            facing[limb.name] = Facing.TOWARD if slant < 0.0 else Facing.AWAY
    return result
