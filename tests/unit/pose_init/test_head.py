"""The neck's rotation from face points."""

import dataclasses

import numpy as np
import pytest

from fitter.body.pose_prior import joint_angles, mean_pose
from fitter.pose_init.click_fit import turn_head
from fitter.pose_init.click_problem import ClickedPoints, ClickProblem, click_problem
from fitter.pose_init.landmark_rig import landmark_points
from tests.unit.pose_init.scenes import PRIOR, RIG, scene

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
