"""Fingers of MakeHuman's neutral woman, half closed."""

import numpy as np
import pytest

from fitter.training.articulation.rig import bone_heads
from fitter.training.articulation.rigged_bodies import (
    FINGERS,
    JOINT_SHARES,
    RELAXED,
    RELAXED_DEGREES,
    finger_rotations,
    with_curled_fingers,
)
from tests.unit.training.makehuman_data import base_mesh, needs_makehuman
from tests.unit.training.rigged_neutral import mesh, neutral_source, rig

pytestmark = needs_makehuman


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


def test_fingers_close_further_the_more_they_bend():
    ways = []
    for degrees in (5.0, 15.0, 30.0):
        curled = with_curled_fingers(rig(), mesh().skin, flat(), heads(), {"left": degrees})
        ways.append(np.linalg.norm(middle_tip(curled) - heads()[bone("wrist.L")]))
    assert ways[0] > ways[1] > ways[2]


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
