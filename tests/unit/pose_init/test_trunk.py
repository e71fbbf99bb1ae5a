"""Trunk and head from clicks, and the limb that gives the scale."""

import dataclasses

import numpy as np
import pytest

from fitter.body.pose_prior import joint_angles, mean_pose
from fitter.errors import InvalidInputError
from fitter.pose_init.click_fit import turn_head
from fitter.pose_init.click_problem import (
    ClickedPoints,
    ClickProblem,
    click_problem,
    clicked_points,
)
from fitter.pose_init.landmark_rig import landmark_points
from fitter.pose_init.lifting import PerspectiveLifting
from fitter.pose_init.limbs import LIMB_NAMES, MIDDLES, limb_named, reference_limb
from fitter.pose_init.start_poses import start_poses
from fitter.pose_init.trunk import trunk_points
from fitter.render.camera import Camera
from fitter.request import Click
from tests.unit.pose_init.scenes import LENGTHS, PRIOR, RIG, scene

FRONT = {
    "right_shoulder": (100.0, 100.0),
    "left_shoulder": (200.0, 110.0),
    "right_hip": (120.0, 260.0),
    "left_hip": (175.0, 262.0),
}


def points(**pixels: tuple[float, float]) -> ClickedPoints:
    return clicked_points({name: Click(x=x, y=y) for name, (x, y) in pixels.items()})


def without(*names: str) -> dict[str, tuple[float, float]]:
    return {name: pixel for name, pixel in FRONT.items() if name not in names}


def test_clicked_corners_stay_and_middles_are_added():
    trunk = trunk_points(points(**FRONT), LENGTHS)
    assert not trunk.guessed
    np.testing.assert_allclose(trunk.pixels["pelvis_middle"], [147.5, 261.0])
    np.testing.assert_allclose(trunk.pixels["thorax_middle"], [150.0, 105.0])


@pytest.mark.parametrize("name", list(FRONT))
def test_a_missing_corner_keeps_the_slant_of_the_other_pair(name):
    trunk = trunk_points(points(**without(name)), LENGTHS)
    assert trunk.guessed == {name}
    shoulders = trunk.pixels["left_shoulder"] - trunk.pixels["right_shoulder"]
    hips = trunk.pixels["left_hip"] - trunk.pixels["right_hip"]
    assert shoulders[0] * hips[1] - shoulders[1] * hips[0] == pytest.approx(0.0, abs=1e-9)
    assert shoulders @ hips > 0.0


def test_hips_out_of_the_picture_lie_below_the_shoulders():
    trunk = trunk_points(points(**without("right_hip", "left_hip"), nose=(150.0, 40.0)), LENGTHS)
    assert trunk.pixels["pelvis_middle"][1] > 150.0
    assert trunk.pixels["left_hip"][0] > trunk.pixels["right_hip"][0]


def test_hips_of_a_person_upside_down_lie_above_the_shoulders():
    trunk = trunk_points(points(**without("right_hip", "left_hip"), nose=(150.0, 170.0)), LENGTHS)
    assert trunk.pixels["pelvis_middle"][1] < 50.0


def test_shoulders_out_of_the_picture_lie_on_the_other_side_of_the_knees():
    trunk = trunk_points(
        points(**without("right_shoulder", "left_shoulder"), left_knee=(180.0, 400.0)), LENGTHS
    )
    assert trunk.pixels["thorax_middle"][1] < 200.0


def test_one_side_alone_is_a_side_view():
    trunk = trunk_points(points(**without("right_shoulder", "right_hip")), LENGTHS)
    np.testing.assert_allclose(trunk.pixels["right_hip"], trunk.pixels["left_hip"])
    np.testing.assert_allclose(trunk.pixels["right_shoulder"], trunk.pixels["left_shoulder"])


@pytest.mark.parametrize("kept", [(), ("left_hip",), ("right_shoulder",)])
def test_too_little_of_the_trunk_is_refused_with_a_remedy(kept):
    with pytest.raises(InvalidInputError) as refused:
        trunk_points(points(**{name: FRONT[name] for name in kept}), LENGTHS)
    assert refused.value.field == "points"
    assert "Click" in refused.value.remedy


PLACE = np.array([[0.0, 0.0, 3.0]])
NECK, HEAD = RIG.part("neck"), RIG.part("head")
FACE = ("nose", "left_eye", "right_eye", "left_ear", "right_ear", "chin", "head_top")


def turned_pose(*, yaw_degrees: float, nod_degrees: float) -> np.ndarray:
    pose = mean_pose(PRIOR)
    for part in (NECK, HEAD):
        angles = np.radians([nod_degrees / 2, 0.0, yaw_degrees / 2])
        pose[part] = PRIOR.axes[part].T @ angles
    return pose


def problem_for(pose: np.ndarray, names: tuple[str, ...]) -> ClickProblem:
    camera = scene(0, noise_px=0.0).camera
    points = landmark_points(RIG, pose, PLACE[0])
    rows = [RIG.landmark_names.index(name) for name in names]
    clicks = ClickedPoints(
        names=names,
        pixels=camera.project(points[rows]),
        spread_m=np.full(len(names), 0.015),
    )
    return click_problem(RIG, PRIOR, camera, clicks, scale=200.0, limb_facing={})


@pytest.mark.parametrize(("yaw", "nod"), [(50.0, 0.0), (-40.0, 10.0), (0.0, 25.0)])
def test_the_head_turns_to_where_the_face_was_clicked(yaw, nod):
    truth = turned_pose(yaw_degrees=yaw, nod_degrees=nod)
    found = turn_head(problem_for(truth, FACE), mean_pose(PRIOR)[None], PLACE)[0]
    angles = np.degrees(joint_angles(PRIOR, found)[[NECK, HEAD]].sum(axis=0))
    np.testing.assert_allclose(angles[[0, 2]], [nod, yaw], atol=12.0)


def test_everything_but_neck_and_head_is_kept():
    truth = turned_pose(yaw_degrees=30.0, nod_degrees=5.0)
    start = scene(1, noise_px=0.0).pose
    found = turn_head(problem_for(truth, FACE), start[None], PLACE)[0]
    others = [part for part in range(17) if part not in (NECK, HEAD)]
    np.testing.assert_array_equal(found[others], start[others])


def test_two_face_points_leave_the_neck_at_the_prior_mean():
    truth = turned_pose(yaw_degrees=50.0, nod_degrees=0.0)
    start = truth[None].copy()
    found = turn_head(problem_for(truth, ("nose", "left_eye", "left_hip")), start, PLACE)[0]
    np.testing.assert_array_equal(found[[NECK, HEAD]], mean_pose(PRIOR)[[NECK, HEAD]])


def test_the_problem_of_the_body_is_not_changed():
    truth = turned_pose(yaw_degrees=20.0, nod_degrees=0.0)
    problem = problem_for(truth, (*FACE, "left_hip"))
    before = dataclasses.replace(problem)
    turn_head(problem, mean_pose(PRIOR)[None], PLACE)
    np.testing.assert_array_equal(problem.pixels, before.pixels)
    assert problem.moving


CAMERA = Camera(focal_length_px=600.0, centre_x=320.0, centre_y=240.0, width=640, height=480)


def seen(pose: np.ndarray, depth: float) -> dict[str, np.ndarray]:
    points = landmark_points(RIG, pose, np.array([0.0, 0.0, depth]))
    pixels = dict(zip(RIG.landmark_names, CAMERA.project(points), strict=True))
    for name, (right, left) in MIDDLES.items():
        pixels[name] = 0.5 * (pixels[right] + pixels[left])
    return pixels


def bent(*parts: str) -> np.ndarray:
    """The mean pose with these parts flexed by 60 degrees toward the camera."""
    pose = mean_pose(PRIOR)
    for name in parts:
        part = RIG.part(name)
        pose[part] = pose[part] + np.radians(60.0) * PRIOR.axes[part, 0]
    return pose


def test_a_foreshortened_limb_is_not_chosen():
    pose = bent("left_thigh", "right_thigh")
    chosen = reference_limb(seen(pose, 3.0), LENGTHS, candidates=("left_thigh", "torso"))
    assert chosen.limb.name == "torso"


def test_its_depth_is_the_smallest_of_all_limbs_bounds():
    pixels = seen(mean_pose(PRIOR), 3.0)
    chosen = reference_limb(pixels, LENGTHS, candidates=LIMB_NAMES)
    depth = CAMERA.focal_length_px / chosen.scale
    assert depth == pytest.approx(3.0, rel=0.06)


@pytest.mark.parametrize(
    "reference", ["torso", "left_thigh", "right_thigh", "left_shin", "right_upper_arm"]
)
def test_the_root_is_found_from_any_parallel_limb(reference):
    """A limb turned parallel to the image fixes the root's depth, wherever in the body it is."""
    pose = mean_pose(PRIOR)
    points = landmark_points(RIG, pose, np.array([0.05, 0.0, 3.0]))
    points = dict(zip(RIG.landmark_names, points, strict=True))
    for name, (right, left) in MIDDLES.items():
        points[name] = 0.5 * (points[right] + points[left])
    limb = limb_named(reference)
    slant = points[limb.distal][2] - points[limb.proximal][2]
    pixels = {name: CAMERA.project(point) for name, point in points.items()}
    starts = start_poses(
        RIG,
        PRIOR,
        PerspectiveLifting(camera=CAMERA),
        pixels,
        LENGTHS,
        limb,
        limb_facing={},
        count=4,
    )
    # Taking a slanted limb for a parallel one errs by the slant, to second order.
    allowed = 0.03 + abs(slant)
    assert np.abs(starts.translation[:, 2] - 3.0).min() < allowed


def test_no_candidate_is_a_programming_error():
    with pytest.raises(ValueError, match="candidate"):
        reference_limb({}, LENGTHS, candidates=())


def test_uncertain_short_limbs_must_lead_clearly():
    pixels = seen(mean_pose(PRIOR), 3.0)
    stretched = dict(pixels)
    forearm = pixels["left_wrist"] - pixels["left_elbow"]
    stretched["left_wrist"] = pixels["left_elbow"] + 1.04 * forearm
    candidates = ("left_forearm", "left_thigh", "torso")
    chosen = reference_limb(stretched, LENGTHS, candidates=candidates)
    assert chosen.limb.name != "left_forearm"
