import numpy as np
import pytest

from fitter.applications.motion import (
    Motion,
    grounded,
    motion_of_cycle,
    moving_body,
    sliding_m,
    sole_vertices,
)
from fitter.applications.named_motions import stride_angles, stride_of
from fitter.applications.poses import beyond_limits, named_pose
from tests.unit.applications.bodies import packaged

WINTER_SPEED_M_S = (0.9, 1.7)
"""Slow to fast walking of adults."""


@pytest.fixture(scope="module", params=["female", "male"])
def body(request):
    return packaged(request.param)


@pytest.fixture(scope="module")
def walking(body):
    motion = motion_of_cycle(stride_of(body.rig), body.rig, frames=2 * stride_of(body.rig).frames)
    return grounded(moving_body(body.evaluator, body.shape, motion), body.model)


def test_every_frame_is_within_the_limits_of_the_joints(body):
    stride = motion_of_cycle(stride_of(body.rig), body.rig, frames=stride_of(body.rig).frames)
    assert {beyond_limits(body.rig, pose) for pose in stride.poses} == {None}


def test_the_stride_is_periodic_and_the_sides_take_turns():
    for phase in np.linspace(0.0, 1.0, 7):
        now, later, half = (stride_angles(phase + shift) for shift in (0.0, 1.0, 0.5))
        for part, held in now.items():
            assert held.flexion == pytest.approx(later[part].flexion)
            assert held.twist == pytest.approx(later[part].twist)
        assert now["left_shin"].flexion == pytest.approx(half["right_shin"].flexion)


def test_frames_follow_each_other_and_the_first_follows_the_last(walking):
    looped = np.concatenate([walking.shapes, walking.shapes[:1]])
    steps = np.linalg.norm(np.diff(looped, axis=0), axis=2).max(axis=1)
    assert steps[-1] <= 1.05 * steps.max()
    assert steps.max() < 0.25


def test_the_lowest_point_of_every_frame_is_on_the_ground(walking):
    lowest = [walking.vertices(frame)[:, 1].min() for frame in range(len(walking.shapes))]
    np.testing.assert_allclose(lowest, 0.0, atol=1e-6)


def test_what_touches_the_ground_of_the_soles_stands_still(body, walking):
    assert sliding_m(walking, body.model) < 0.002


def test_it_goes_forward_at_a_walkers_speed(walking):
    way = walking.roots[-1] - walking.roots[0]
    seconds = (len(walking.roots) - 1) * walking.motion.frame_time_s
    assert WINTER_SPEED_M_S[0] < way[2] / seconds < WINTER_SPEED_M_S[1]
    assert abs(way[0]) < 0.05 * way[2]
    assert np.ptp(walking.roots[:, 1]) < 0.07


def test_both_feet_carry_it_in_turn(body, walking):
    soles = sole_vertices(body.model)
    left = body.model.mean_vertices[soles, 0] > 0.0
    heights = np.stack([walking.vertices(frame)[soles, 1] for frame in range(len(walking.shapes))])
    on_left, on_right = (heights[:, side].min(axis=1) < 0.005 for side in (left, ~left))
    assert (on_left | on_right).all()
    assert 0.4 < on_left.mean() < 0.8
    assert 0.4 < on_right.mean() < 0.8


def test_a_lift_of_the_source_is_kept(body):
    poses = np.repeat(named_pose(body.rig, "standing")[None], 3, axis=0)
    motion = Motion(
        frame_time_s=0.1,
        poses=poses,
        roots=np.array([[0.0, 0.8, 0.0], [0.1, 0.8, 0.2], [0.2, 0.8, 0.4]]),
        lifts_m=np.array([0.0, 0.3, 0.3]),
    )
    placed = grounded(moving_body(body.evaluator, body.shape, motion), body.model)
    lowest = [placed.vertices(frame)[:, 1].min() for frame in range(3)]
    np.testing.assert_allclose(lowest, [0.0, 0.3, 0.3], atol=1e-6)
    # In the air it moves as the source's root does.
    np.testing.assert_allclose(
        placed.roots[2, [0, 2]] - placed.roots[1, [0, 2]], [0.1, 0.2], atol=1e-6
    )


def test_a_standing_person_stays_where_it_is_though_its_source_slides(body):
    poses = np.repeat(named_pose(body.rig, "standing")[None], 4, axis=0)
    roots = np.array([[0.01 * frame, 0.8, 0.02 * frame] for frame in range(4)])
    motion = Motion(frame_time_s=0.1, poses=poses, roots=roots, lifts_m=np.zeros(4))
    moving = moving_body(body.evaluator, body.shape, motion)
    placed = grounded(moving, body.model)
    assert np.abs(np.diff(placed.roots, axis=0)).max() < 1e-4
    assert sliding_m(placed, body.model) < 1e-4
