"""Clicked scenes of the stick person, with their truth."""

from dataclasses import dataclass

import numpy as np

from fitter.observation.clicks import click_spread_m
from fitter.pose_init.click_fit import FittedPoses
from fitter.pose_init.click_problem import ClickedPoints, ClickProblem, click_problem
from fitter.pose_init.initial_pose import reference_of, refined_hypotheses
from fitter.pose_init.landmark_rig import landmark_points
from fitter.pose_init.lifting import PerspectiveLifting
from fitter.pose_init.limbs import LIMBS, MIDDLES, limb_lengths_m
from fitter.pose_init.trunk import trunk_points
from fitter.render.camera import Camera
from fitter.request import Click
from fitter.vocabulary.choices import Facing
from tests.unit.pose_init.stick_figure import plausible_pose, stick_figure, stick_prior

RIG = stick_figure()
PRIOR = stick_prior(RIG)
LENGTHS = limb_lengths_m(RIG)
CLICKED = [
    "nose",
    "left_eye",
    "right_eye",
    "left_ear",
    "right_ear",
    "left_shoulder",
    "right_shoulder",
    "left_elbow",
    "right_elbow",
    "left_wrist",
    "right_wrist",
    "left_hip",
    "right_hip",
    "left_knee",
    "right_knee",
    "left_ankle",
    "right_ankle",
    "neck",
    "head_top",
]
CLICK_SPREADS_M = np.array([click_spread_m(name, Click(x=0.0, y=0.0)) for name in CLICKED])
BODY = [
    RIG.landmark_names.index(name)
    for name in CLICKED
    if name.endswith(("shoulder", "elbow", "wrist", "hip", "knee", "ankle"))
]
HIPS = [RIG.landmark_names.index(name) for name in ("left_hip", "right_hip")]


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Scene:
    camera: Camera
    pose: np.ndarray
    translation: np.ndarray
    points: np.ndarray
    clicks: ClickedPoints
    facing: dict[str, Facing]


def scene(
    seed: int,
    *,
    noise_px: float,
    distance: float | None = None,
    focal_length_px: float = 600.0,
    yaw: float | None = None,
) -> Scene:
    rng = np.random.default_rng(seed)
    angle = rng.uniform(-np.pi, np.pi)
    pose = plausible_pose(PRIOR, rng, yaw=angle if yaw is None else yaw)
    depth = rng.uniform(2.4, 4.0)
    place = np.array([rng.normal(0, 0.1), rng.normal(0, 0.05), distance or depth])
    camera = Camera(
        focal_length_px=focal_length_px, centre_x=320.0, centre_y=240.0, width=640, height=480
    )
    points = landmark_points(RIG, pose, place)
    rows = [RIG.landmark_names.index(name) for name in CLICKED]
    pixels = camera.project(points[rows]) + noise_px * rng.standard_normal((len(rows), 2))
    return Scene(
        camera=camera,
        pose=pose,
        translation=place,
        points=points,
        clicks=ClickedPoints(
            names=tuple(CLICKED),
            pixels=pixels,
            spread_m=CLICK_SPREADS_M,
        ),
        facing=true_facing(points, margin_m=0.05),
    )


def true_facing(points: np.ndarray, *, margin_m: float) -> dict[str, Facing]:
    """The word of a caller who speaks only of limbs that clearly slant."""

    def depth(name: str) -> float:
        return float(
            np.mean([points[RIG.landmark_names.index(n), 2] for n in MIDDLES.get(name, (name,))])
        )

    slants = {limb.name: depth(limb.distal) - depth(limb.proximal) for limb in LIMBS}
    return {
        name: Facing.TOWARD if slant < 0 else Facing.AWAY
        for name, slant in slants.items()
        if abs(slant) > margin_m
    }


def solve(
    camera: Camera, clicks: ClickedPoints, facing: dict[str, Facing]
) -> tuple[ClickProblem, FittedPoses]:
    trunk = trunk_points(clicks, LENGTHS)
    reference = reference_of(clicks, trunk, LENGTHS)
    problem = click_problem(RIG, PRIOR, camera, clicks, scale=reference.scale, limb_facing=facing)
    fitted = refined_hypotheses(
        problem,
        PerspectiveLifting(camera=camera),
        pixels={**clicks.by_name(), **trunk.pixels},
        lengths_m=LENGTHS,
        reference=reference,
        limb_facing=facing,
    )
    return problem, fitted


def body_points(fitted: FittedPoses, row: int = 0) -> np.ndarray:
    """Body landmarks of one fitted pose, camera frame."""
    return landmark_points(RIG, fitted.pose[row], fitted.translation[row])


def errors_mm(points: np.ndarray, truth: np.ndarray) -> np.ndarray:
    """Distance of each limb end from the truth, both relative to the middle of the hips."""

    def relative(p: np.ndarray) -> np.ndarray:
        return p[BODY] - p[HIPS].mean(axis=0)

    return 1e3 * np.linalg.norm(relative(points) - relative(truth), axis=1)
