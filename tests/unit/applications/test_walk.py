"""The walk: within the limits of the joints, on the ground, without a jump, in place."""

from dataclasses import replace

import numpy as np
import pytest

from fitter.applications.animation import motion_of_walk
from fitter.applications.motion import (
    SPOT_M,
    Motion,
    grounded,
    in_place,
    motion_of_cycle,
    moving_body,
    sliding_m,
    sole_vertices,
)
from fitter.applications.poses import beyond_limits, named_pose
from fitter.applications.walk import stride_angles, stride_of
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


def test_the_stride_is_periodic_and_the_sides_take_turns():
    for phase in np.linspace(0.0, 1.0, 7):
        now, later, half = (stride_angles(phase + shift) for shift in (0.0, 1.0, 0.5))
        for part, held in now.items():
            assert held.flexion == pytest.approx(later[part].flexion)
            assert held.twist == pytest.approx(later[part].twist)
        assert now["left_shin"].flexion == pytest.approx(half["right_shin"].flexion)


def test_every_frame_is_within_the_limits_of_the_joints(body, walking):
    assert {beyond_limits(body.rig, pose) for pose in walking.motion.poses} == {None}


def test_a_walk_has_no_jump_between_frames(walking):
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
    of_walk = moving_body(body.evaluator, body.shape, motion)
    placed = grounded(of_walk, body.model)
    assert np.abs(np.diff(placed.roots, axis=0)).max() < 1e-4
    assert sliding_m(placed, body.model) < 1e-4


def test_a_stretch_of_the_walk_is_what_was_asked_for(body):
    whole = motion_of_walk(body.rig)
    frame_time_s = whole.motion.frame_time_s
    assert len(whole.motion.poses) == 3 * stride_of(body.rig).frames
    found = motion_of_walk(body.rig, start_s=7 * frame_time_s, duration_s=20 * frame_time_s)
    np.testing.assert_allclose(found.motion.poses, whole.motion.poses[7:27])
    assert (found.motion.frame_time_s, found.warnings) == (frame_time_s, ())
    # It has no end, and no stretch lies outside of it.
    later = motion_of_walk(body.rig, start_s=3_600.0, duration_s=1e-3).motion
    assert len(later.poses) == 1
    later = motion_of_walk(body.rig, start_s=1.0).motion
    assert len(later.poses) == len(whole.motion.poses)


def test_a_walk_in_place_stays_on_its_spot_and_can_be_repeated(walking):
    assert np.ptp(walking.roots[:, 2]) > 0.9
    made = in_place(walking)
    assert np.linalg.norm(made.roots[:, [0, 2]], axis=1).max() < 0.06
    np.testing.assert_allclose(made.roots[0, [0, 2]], made.roots[-1, [0, 2]], atol=1e-9)


def test_a_body_in_place_neither_leaves_the_frame_nor_slides_where_it_only_sways(walking):
    """There and back, and round in circles; heights stay."""
    angles = np.linspace(0.0, 4.0 * np.pi, len(walking.roots))
    slow = replace(walking, motion=replace(walking.motion, frame_time_s=0.3))

    def going(way):
        return replace(slow, roots=np.column_stack([way[0], 0.01 * angles, way[1]]))

    for way in ((0 * angles, 3 * np.sin(angles / 4)), (2 * np.cos(angles), 2 * np.sin(angles))):
        made = in_place(going(way)).roots
        assert np.linalg.norm(made[:, [0, 2]], axis=1).max() < SPOT_M
        np.testing.assert_array_equal(made[:, 1], 0.01 * angles)
    swaying = going((0.2 * np.sin(angles), 0 * angles))
    np.testing.assert_allclose(in_place(swaying).roots, swaying.roots, atol=1e-9)
