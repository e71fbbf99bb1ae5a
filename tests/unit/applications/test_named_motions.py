"""Motions by name: within the limits of the joints, on the ground, without a jump; and the walk."""

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
from fitter.applications.named_motions import NAMED_MOTIONS, least_jerk, stride_angles, stride_of
from fitter.applications.poses import beyond_limits, named_pose
from tests.unit.applications.bodies import packaged

GENDERS = ("female", "male")
ON_THE_SPOT = [name for name in NAMED_MOTIONS if name != "walk"]


def motion_of(body, name):
    cycle = NAMED_MOTIONS[name](body.rig)
    return motion_of_cycle(cycle, body.rig, frames=cycle.frames)


def moving(body, name):
    return grounded(moving_body(body.evaluator, body.shape, motion_of(body, name)), body.model)


def centre_of_volume(vertices, triangles):
    """Σ V (a + b + c) / 4 over tetrahedra to the origin, by their signed volumes V."""
    corners = vertices[triangles].astype(float)
    volumes = np.einsum("fi,fi->f", corners[:, 0], np.cross(corners[:, 1], corners[:, 2]))
    return (volumes[:, None] * corners.sum(axis=1) / 4.0).sum(axis=0) / volumes.sum()


def test_least_jerk_begins_and_ends_at_rest_half_way_in_half_the_time():
    assert [least_jerk(share) for share in (0.0, 0.5, 1.0)] == [0.0, 0.5, 1.0]
    assert least_jerk(1e-3) < 1e-7
    assert 1.0 - least_jerk(1.0 - 1e-3) < 1e-7


@pytest.mark.parametrize("gender", GENDERS)
@pytest.mark.parametrize("name", list(NAMED_MOTIONS))
def test_every_frame_is_within_the_limits_of_the_joints(name, gender):
    body = packaged(gender)
    assert {beyond_limits(body.rig, pose) for pose in motion_of(body, name).poses} == {None}


@pytest.mark.parametrize("gender", GENDERS)
@pytest.mark.parametrize("name", ON_THE_SPOT)
def test_it_stays_on_the_ground_and_on_the_spot(name, gender):
    body = packaged(gender)
    found = moving(body, name)
    lowest = [found.vertices(frame)[:, 1].min() for frame in range(len(found.shapes))]
    np.testing.assert_allclose(lowest, found.motion.lifts_m, atol=1e-6)
    assert sliding_m(found, body.model) < 0.0035
    way = np.abs(found.roots[-1] - found.roots[0])[[0, 2]]
    assert way.max() < 0.02


@pytest.mark.parametrize("name", ON_THE_SPOT)
def test_frames_follow_each_other_and_the_first_follows_the_last(name):
    body = packaged("female")
    found = moving(body, name)
    bodies = np.stack([found.vertices(frame) for frame in range(len(found.shapes))])
    steps = np.linalg.norm(np.diff(np.concatenate([bodies, bodies[:1]]), axis=0), axis=2)
    assert steps.max() < 0.25
    assert steps[-1].max() <= 1.05 * steps[:-1].max()


@pytest.mark.parametrize("gender", GENDERS)
def test_who_squats_keeps_the_balance_with_level_thighs(gender):
    body = packaged(gender)
    found = moving(body, "squat")
    soles = sole_vertices(body.model)
    heights = [found.vertices(frame)[:, 1].max() for frame in range(len(found.shapes))]
    assert min(heights) < 0.75 * max(heights)
    for frame in range(0, len(found.shapes), 4):
        vertices = found.vertices(frame)
        on_ground = vertices[soles][vertices[soles, 1] < 0.01]
        centre = centre_of_volume(vertices, body.model.triangles)
        assert on_ground[:, 2].min() < centre[2] < on_ground[:, 2].max()
        assert on_ground[:, 0].min() < centre[0] < on_ground[:, 0].max()


def test_who_waves_has_the_right_hand_beside_the_head_and_moves_it_to_and_fro():
    body = packaged("male")
    found = moving(body, "wave")
    hand = np.unique(
        body.model.triangles[body.model.part_of_triangle == body.rig.index("right_hand")]
    )
    places = np.stack(
        [found.vertices(frame)[hand].mean(axis=0) for frame in range(len(found.shapes))]
    )
    swinging = places[places[:, 1] > 0.85 * found.vertices(0)[:, 1].max()]
    assert len(swinging) > 0.4 * len(places)
    assert np.ptp(swinging[:, 0]) > 0.2
    turns = np.diff(np.sign(np.diff(swinging[:, 0])))
    assert np.count_nonzero(turns) >= 5


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
