"""Bodies as the rig poses them: shoulder girdle and relaxed hands, on MakeHuman's neutral woman."""

from functools import cache

import numpy as np
import pytest

from fitter.arrays import Pose, Vertices
from fitter.body.model import regress
from fitter.numerics.rotations import rotation_vectors
from fitter.training.articulation.parts import part_index
from fitter.training.articulation.rig import (
    Rig,
    bone_heads,
    bone_rotations,
    part_weights,
    swing_and_twist,
)
from fitter.training.articulation.rig_drives import (
    FROM_DEGREES,
    TO_DEGREES,
    raised_shares,
    rest_axis,
    smooth_step,
)
from fitter.training.articulation.rigged_bodies import (
    FINGERS,
    JOINT_SHARES,
    RELAXED,
    RELAXED_DEGREES,
    RegisteredBodies,
    finger_rotations,
    rigged_bodies,
    rigged_mesh,
    with_curled_fingers,
)
from tests.unit.training.makehuman_data import base_mesh, landmarks, needs_makehuman
from tests.unit.training.rigged_neutral import mesh, neutral_body, neutral_source, rig

pytestmark = needs_makehuman

ARM = rest_axis("left_upper_arm")


@cache
def girdled() -> Rig:
    return mesh().rig


@cache
def painted_body() -> RegisteredBodies:
    return rigged_bodies(rigged_mesh(base_mesh(), rig()), neutral_source()[None])


def arms_at(degrees: float, *, turned: float = 0.0) -> Pose:
    """Both arms straight out and up by an angle from straight down, twisted about themselves."""
    raised = np.radians(degrees) - np.arctan2(ARM[0], -ARM[1])
    pose = np.zeros((17, 3))
    pose[part_index("left_upper_arm")] = [0.0, 0.0, raised]
    pose[part_index("right_upper_arm")] = [0.0, 0.0, -raised]
    if turned:
        pose[part_index("left_upper_arm")] = turned * ARM
    return pose


@cache
def raised(degrees: float, *, painted: bool) -> Vertices:
    body = painted_body() if painted else neutral_body()
    return body.posed(0, arms_at(degrees))


def bone_degrees(rig_: Rig, name: str, pose: Pose) -> float:
    turn = bone_rotations(rig_, pose)[[rig_.bone_names.index(name)]]
    return float(np.degrees(np.linalg.norm(rotation_vectors(turn))))


def test_an_arm_is_not_raised_below_the_shoulder_and_is_all_raised_overhead():
    angles = np.radians([20.0, FROM_DEGREES - 1.0, 110.0, TO_DEGREES + 1.0, 175.0])
    down = np.array([0.0, -1.0, 0.0])
    for axis in ([0.0, 0.0, 1.0], [-1.0, 0.0, 0.0], [-0.6, 0.0, 0.8]):
        turns = angles[:, None] * np.array(axis)
        shares = raised_shares(turns, np.tile(down, (len(angles), 1)))
        np.testing.assert_allclose(shares, [0.0, 0.0, 0.5, 1.0, 1.0], atol=1e-9)


def test_the_share_grows_without_a_jump():
    way = np.linspace(-0.5, 1.5, 400)
    steps = np.diff(smooth_step(way))
    assert (steps >= 0.0).all()
    assert steps.max() < 1.6 * (way[1] - way[0])


def test_the_collar_bone_rises_by_30_to_40_degrees_and_the_blade_by_50_to_70():
    pose = arms_at(170.0)
    assert 30.0 < bone_degrees(girdled(), "clavicle.L", pose) < 40.0
    assert 50.0 < bone_degrees(girdled(), "shoulder01.R", pose) < 70.0
    assert bone_degrees(rig(), "clavicle.L", pose) < 20.0


@pytest.mark.parametrize("degrees", [10.0, 40.0, 59.0])
def test_bones_turn_as_before_while_the_arms_are_low(degrees: float):
    pose = arms_at(degrees)
    np.testing.assert_array_equal(bone_rotations(girdled(), pose), bone_rotations(rig(), pose))


def test_twisting_an_arm_leaves_the_girdle_alone():
    pose = arms_at(40.0, turned=0.9)
    pose[part_index("right_upper_arm")] = 0.0
    swing, _ = swing_and_twist(pose[[part_index("left_upper_arm")]], ARM[None])
    np.testing.assert_allclose(swing, 0.0, atol=1e-12)
    assert bone_degrees(girdled(), "clavicle.L", pose) < 1e-6


def test_every_vertex_keeps_the_sum_of_its_weights_and_none_is_negative():
    before, after = (each.weights.toarray() for each in (rig(), girdled()))
    np.testing.assert_allclose(after.sum(axis=1), before.sum(axis=1), atol=1e-12)
    assert after.min() >= 0.0


def test_weights_of_both_sides_are_mirror_images():
    names = girdled().bone_names
    mirrored = [
        names.index(name[:-1] + {"L": "R", "R": "L"}[name[-1]])
        if name.endswith((".L", ".R"))
        else names.index(name)
        for name in names
    ]
    skins = [each.weights.toarray()[base_mesh().body_vertex_ids] for each in (rig(), girdled())]
    unlike = [np.abs(skin[base_mesh().mirror][:, mirrored] - skin).max() for skin in skins]
    assert unlike[1] < unlike[0] + 1e-3


def test_only_shoulders_arms_and_upper_trunk_change_hands():
    skins = [part_weights(each, each.weights) for each in (rig(), girdled())]
    changed = np.abs(skins[1] - skins[0]).max(axis=0)
    for name in ("pelvis", "head", "left_forearm", "right_thigh"):
        assert changed[part_index(name)] == 0.0


def test_at_rest_nothing_moves():
    body = neutral_body()
    np.testing.assert_allclose(body.posed(0, np.zeros((17, 3))), body.rest[0], atol=1e-9)


def test_arms_overhead_lift_the_shoulders_to_the_chin_and_inward():
    rows = landmarks()
    tips = [rows.names.index(f"{side}_acromion") for side in ("left", "right")]
    chin = rows.names.index("chin")
    at_rest = regress(rows, neutral_body().rest[0])
    painted, mended = (regress(rows, raised(165.0, painted=each)) for each in (True, False))
    for tip in tips:
        assert mended[tip, 1] > painted[tip, 1] + 0.02
        assert abs(mended[tip, 0]) < abs(at_rest[tip, 0]) - 0.02
        assert abs(mended[tip, 1] - mended[chin, 1]) < 0.06


def heads() -> np.ndarray:
    return bone_heads(rig(), neutral_source())


def flat() -> np.ndarray:
    return base_mesh().body(neutral_source())


def bone(name: str) -> int:
    return rig().bone_names.index(name)


def relaxed() -> np.ndarray:
    return with_curled_fingers(rig(), mesh().skin, flat(), heads(), RELAXED)


def fingers_weight() -> np.ndarray:
    named = np.array(["finger" in name for name in rig().bone_names])
    return mesh().skin @ named.astype(float)


def middle_tip(vertices: np.ndarray) -> np.ndarray:
    """The tip of the left middle finger of a body."""
    last = mesh().skin[:, [bone("finger3-3.L")]].toarray()[:, 0] > 0.9
    wrist = heads()[bone("wrist.L")]
    members = np.flatnonzero(last)
    farthest = members[np.argmax(np.linalg.norm(flat()[members] - wrist, axis=1))]
    return vertices[farthest]


def test_only_fingers_move():
    moved = np.linalg.norm(relaxed() - flat(), axis=1)
    assert moved[fingers_weight() == 0.0].max() < 1e-12
    assert 0.01 < moved.max() < 0.08


def test_no_bend_moves_no_finger_along_its_hinge_and_leaves_the_wrist():
    rotations = finger_rotations(rig().bone_names, heads(), RELAXED)
    assert np.allclose(rotations[bone("wrist.L")], np.eye(3))
    np.testing.assert_allclose(
        rotations @ rotations.transpose(0, 2, 1),
        np.tile(np.eye(3), (len(rotations), 1, 1)),
        atol=1e-12,
    )
    np.testing.assert_allclose(np.linalg.det(rotations), 1.0)


def test_finger_tips_go_to_the_palm():
    # The left palm of the rest pose faces the body and down.
    way = middle_tip(relaxed()) - middle_tip(flat())
    assert way[0] < -0.01


def test_joints_of_a_finger_bend_by_their_shares():
    rotations = finger_rotations(rig().bone_names, heads(), RELAXED)
    turns = [rotations[bone(f"finger3-{joint}.L")] for joint in (1, 2, 3)]
    for one, next_one, share in zip(turns[:-1], turns[1:], JOINT_SHARES[1:], strict=True):
        between = next_one @ one.T
        angle = np.degrees(np.arccos((np.trace(between) - 1.0) / 2.0))
        assert angle == pytest.approx(share * RELAXED_DEGREES, abs=1e-6)


def test_the_fan_of_the_fingers_narrows():
    def tips(vertices_rotations: np.ndarray | None) -> float:
        directions = []
        for finger in (FINGERS[0], FINGERS[-1]):
            first, second = bone(f"finger{finger}-1.L"), bone(f"finger{finger}-2.L")
            way = heads()[second] - heads()[first]
            if vertices_rotations is not None:
                way = vertices_rotations[first] @ way
            directions.append(way / np.linalg.norm(way))
        return float(np.degrees(np.arccos(directions[0] @ directions[1])))

    rotations = finger_rotations(rig().bone_names, heads(), RELAXED)
    assert tips(rotations) < 0.6 * tips(None)


def test_left_and_right_hands_mirror_each_other():
    found = relaxed()
    mirrored = found[mesh().surface.mirror] * [-1.0, 1.0, 1.0]
    moved = fingers_weight() > 0.0
    assert np.abs(mirrored[moved] - found[moved]).max() < 5e-4
