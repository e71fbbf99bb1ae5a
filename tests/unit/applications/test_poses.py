import numpy as np
import pytest

from fitter.applications.poses import (
    NAMED_POSES,
    Angles,
    angled_pose,
    beyond_limits,
    named_pose,
    shortest_rotation,
    spelled_pose,
)
from fitter.body.model import global_rotations, posed_joints, regress
from fitter.errors import InvalidInputError
from fitter.numerics.rotations import rotation_matrices
from tests.unit.applications.bodies import packaged


@pytest.fixture(scope="module", params=["female", "male"])
def body(request):
    return packaged(request.param)


def bone_direction(body, pose, part, end):
    """Where a posed bone points, body frame."""
    rig = body.rig
    joints = posed_joints(rig.rest_joints, global_rotations(pose, rig.part_parent), rig.part_parent)
    bone = joints[rig.index(end)] - joints[rig.index(part)]
    return bone / np.linalg.norm(bone)


@pytest.mark.parametrize("name", NAMED_POSES)
def test_a_named_pose_is_within_the_limits_of_the_joints(body, name):
    assert beyond_limits(body.rig, named_pose(body.rig, name)) is None


@pytest.mark.parametrize("name", NAMED_POSES)
def test_a_named_pose_stands_or_sits_on_the_soles(body, name):
    vertices = body.vertices(named_pose(body.rig, name))
    feet = np.isin(
        np.arange(len(vertices)),
        body.model.triangles[
            np.isin(
                body.model.part_of_triangle,
                [body.rig.index(f"{s}_foot") for s in ("left", "right")],
            )
        ],
    )
    assert np.isfinite(vertices).all()
    assert vertices[:, 1].argmin() in np.flatnonzero(feet)


@pytest.mark.parametrize(
    ("angles", "direction"),
    [
        (Angles(), (0.0, -1.0, 0.0)),
        (Angles(abduction=90), (1.0, 0.0, 0.0)),
        (Angles(flexion=90), (0.0, 0.0, 1.0)),
        (Angles(flexion=170), (0.0, np.cos(np.radians(10)), np.sin(np.radians(10)))),
        (Angles(flexion=60, twist=40), (0.0, -0.5, np.sqrt(0.75))),
    ],
)
@pytest.mark.parametrize("side", ["left", "right"])
def test_clinical_angles_say_where_an_upper_arm_points(body, angles, direction, side):
    pose = angled_pose(body.rig, {f"{side}_upper_arm": angles})
    mirrored = np.array(direction) * ([-1, 1, 1] if side == "right" else [1, 1, 1])
    found = bone_direction(body, pose, f"{side}_upper_arm", f"{side}_forearm")
    np.testing.assert_allclose(found, mirrored, atol=1e-9)


def test_a_knee_flexed_by_ninety_degrees_is_a_right_angle(body):
    pose = angled_pose(body.rig, {"left_thigh": Angles(), "left_shin": Angles(flexion=90)})
    thigh = bone_direction(body, pose, "left_thigh", "left_shin")
    shin = bone_direction(body, pose, "left_shin", "left_foot")
    # A knee's sideways angle at rest stays, and takes a little of the right angle.
    assert np.degrees(np.arccos(thigh @ shin)) == pytest.approx(90.0, abs=3.0)
    assert shin[2] < 0.0


def test_the_level_arms_of_the_t_pose_are_level_on_the_mesh_too(body):
    vertices = body.vertices(named_pose(body.rig, "t_pose"))
    names = body.model.landmarks.names
    points = dict(zip(names, regress(body.model.landmarks, vertices), strict=True))
    for side in ("left", "right"):
        arm = points[f"{side}_wrist"] - points[f"{side}_elbow"]
        assert abs(arm[1]) < 0.12 * np.linalg.norm(arm)


def test_shortest_rotation_leads_there_and_turns_about_the_common_normal():
    rng = np.random.default_rng(3)
    for _ in range(20):
        start, end = rng.normal(size=(2, 3))
        turn = shortest_rotation(start, end)
        np.testing.assert_allclose(
            turn @ start / np.linalg.norm(start), end / np.linalg.norm(end), atol=1e-12
        )
        normal = np.cross(start, end)
        np.testing.assert_allclose(turn @ normal, normal, atol=1e-9)
    np.testing.assert_array_equal(shortest_rotation(start, start), np.eye(3))


@pytest.mark.parametrize("direction", [[0, 0, 1], [0, 1, 0], [1, 0, 0], [0.6, -0.8, 0], [1, 2, 3]])
def test_shortest_rotation_to_the_opposite_is_half_a_turn(direction):
    turn = shortest_rotation(np.array(direction, float), -2.0 * np.array(direction, float))
    np.testing.assert_allclose(turn @ direction, -np.array(direction), atol=1e-12)
    assert np.trace(turn) == pytest.approx(-1.0)
    assert np.linalg.det(turn) == pytest.approx(1.0)


def test_rotation_vector_and_quaternion_of_the_same_turn_give_the_same_pose(body):
    half = np.radians(20.0)
    quaternion = [0.0, 0.0, np.sin(half), np.cos(half)]
    vector = [0.0, 0.0, 2.0 * half]
    poses = [
        spelled_pose(body.rig, {"left_upper_arm": numbers})
        for numbers in (vector, quaternion, [-q for q in quaternion])
    ]
    np.testing.assert_allclose(poses[1], poses[0], atol=1e-12)
    np.testing.assert_allclose(poses[2], poses[0], atol=1e-12)


def test_a_turn_the_long_way_round_is_the_short_turn(body):
    vector = np.array([0.0, 0.3, 0.0])
    longer = vector * (1.0 - 2.0 * np.pi / 0.3)
    pose = spelled_pose(body.rig, {"pelvis": longer.tolist()})
    np.testing.assert_allclose(
        rotation_matrices(pose)[0], rotation_matrices(vector[None])[0], atol=1e-12
    )


def test_parts_left_out_keep_the_pose_it_begins_with(body):
    standing = named_pose(body.rig, "standing")
    pose = spelled_pose(body.rig, {"head": [0.0, 0.3, 0.0]}, beginning=standing)
    index = body.rig.index("head")
    np.testing.assert_array_equal(np.delete(pose, index, 0), np.delete(standing, index, 0))
    assert not np.array_equal(pose[index], standing[index])


def refusal(call) -> InvalidInputError:
    with pytest.raises(InvalidInputError) as caught:
        call()
    return caught.value


def test_an_unknown_pose_is_refused_with_the_names_there_are(body):
    error = refusal(lambda: named_pose(body.rig, "handstand"))
    assert error.code == "pose-unknown"
    assert all(name in error.remedy for name in NAMED_POSES)


@pytest.mark.parametrize(
    ("part", "numbers", "word"),
    [
        ("tail", [0, 0, 0], "no part"),
        ("head", [0, 0], "3 or 4"),
        ("head", [0, 0, 0, 0, 1], "3 or 4"),
        ("head", [0, np.nan, 0], "finite"),
        ("head", [0, np.inf, 0], "finite"),
        ("head", [0, 90, 0], "whole turn"),
        ("head", [0, 0, 0, 0], "not 1"),
        ("left_shin", [-1.0, 0, 0], "flexion"),
        ("head", [0, 2.0, 0], "twist"),
    ],
)
def test_rotations_that_cannot_be_are_refused_by_the_name_of_the_part(body, part, numbers, word):
    error = refusal(lambda: spelled_pose(body.rig, {part: numbers}))
    assert (error.code, error.field) == ("rotation-unusable", f"rotations.{part}")
    assert word in error.reason
    assert error.remedy.endswith(".")
