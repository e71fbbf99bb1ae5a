import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from fitter.applications.bvh import parse_bvh
from fitter.applications.poses import NAMED_POSES, named_pose, shortest_rotation
from fitter.applications.retarget import retarget
from fitter.body.skeleton import global_rotations, posed_joints
from fitter.errors import InvalidInputError
from tests.shared_data import SHARED_DATA, needs_shared
from tests.unit.applications.bodies import packaged
from tests.unit.applications.bvh_files import CMU, MIXAMO, NAMES, bvh_of

CLIP = SHARED_DATA / "mocap" / "cmu_131_01.bvh"

Z_UP = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]])
BACK_TO_FRONT = np.diag([-1.0, 1.0, -1.0])


@pytest.fixture(scope="module")
def body():
    return packaged("female")


@pytest.fixture(scope="module")
def poses(body):
    """Named poses, the first one facing forward and the others turned."""
    poses = np.stack([named_pose(body.rig, name) for name in NAMED_POSES])
    poses[1:, 0] = np.linspace([0.0, -2.5, 0.1], [0.1, 2.9, 0.0], len(poses) - 1)
    return poses


@pytest.fixture(scope="module")
def roots(poses):
    """A way above the ground that begins over the origin."""
    places = np.cumsum(np.full((len(poses), 3), [0.1, 0.0, 0.3]), axis=0)
    return places - places[0] + [0.0, 0.9, 0.0]


def same_rotations(first, second, atol=1e-6):
    difference = Rotation.from_rotvec(first.reshape(-1, 3)).inv() * Rotation.from_rotvec(
        second.reshape(-1, 3)
    )
    assert difference.magnitude().max() < atol


@pytest.mark.parametrize("program", NAMES)
@pytest.mark.parametrize("order", ["ZXY", "XYZ", "YZX"])
def test_the_persons_own_motion_comes_back_under_any_programs_names(
    body, poses, roots, program, order
):
    content = bvh_of(body.rig, names=NAMES[program], poses=poses, roots=roots, order=order)
    found = retarget(parse_bvh(content), body.rig, slice(None))
    assert found.naming == program
    assert found.scale == pytest.approx(1.0, abs=1e-6)
    same_rotations(found.motion.poses, poses)
    np.testing.assert_allclose(
        found.motion.roots[:, [0, 2]], (roots - roots[0])[:, [0, 2]], atol=1e-6
    )


@pytest.mark.parametrize("axes", [Z_UP, BACK_TO_FRONT, Z_UP @ BACK_TO_FRONT])
def test_neither_axes_nor_unit_of_the_file_matter(body, poses, roots, axes):
    content = bvh_of(body.rig, names=MIXAMO, poses=poses, roots=roots, axes=axes, unit_m=0.01)
    found = retarget(parse_bvh(content), body.rig, slice(None))
    assert found.scale == pytest.approx(0.01, rel=1e-6)
    same_rotations(found.motion.poses, poses)
    np.testing.assert_allclose(
        found.motion.roots[:, [0, 2]], (roots - roots[0])[:, [0, 2]], atol=1e-6
    )


def test_a_source_that_rests_in_a_t_pose_moves_the_bones_alike(body, poses, roots):
    """Its limbs point elsewhere at rest; posed, ours must point where its do."""
    rig = body.rig
    turns = {}
    for side, sign in (("left", 1.0), ("right", -1.0)):
        level = np.array([sign, 0.0, 0.0])
        for part, end in (("upper_arm", "forearm"), ("forearm", "hand")):
            bone = rig.bone(f"{side}_{part}", f"{side}_{end}")
            turns[f"{side}_{part}"] = shortest_rotation(bone, level)
        turns[f"{side}_hand"] = turns[f"{side}_forearm"]
    content = bvh_of(rig, names=MIXAMO, poses=poses, roots=roots, rest_turns=turns)
    found = retarget(parse_bvh(content), rig, slice(None))
    same_rotations(found.motion.poses, poses)


def test_feet_that_lean_with_splayed_legs_at_rest_stand_flat(body, poses, roots):
    """As CMU's: legs 20 degrees apart, and the feet made in the frames of the shins."""
    rig = body.rig
    turns = {}
    for side, sign in (("left", 1.0), ("right", -1.0)):
        outward = np.array([sign * np.sin(np.radians(20)), -np.cos(np.radians(20)), 0.0])
        for part, end in (("thigh", "shin"), ("shin", "foot")):
            bone = rig.bone(f"{side}_{part}", f"{side}_{end}")
            turns[f"{side}_{part}"] = shortest_rotation(bone, outward)
        turns[f"{side}_foot"] = shortest_rotation(np.array([0.0, -1.0, 0.0]), outward)
    content = bvh_of(rig, names=CMU, poses=poses, roots=roots, rest_turns=turns).decode()
    for sign in (1.0, -1.0):
        # The toes: forward, and down along the shin.
        down = 0.05 * np.array([sign * np.sin(np.radians(20)), -np.cos(np.radians(20)), 0.0])
        name = CMU["left_foot" if sign > 0 else "right_foot"]
        start = content.index(f"JOINT {name}")
        end = content.index("OFFSET 0.0 -0.05 0.1", start)
        content = (
            content[:end]
            + f"OFFSET {down[0]} {down[1]} 0.1"
            + content[end + len("OFFSET 0.0 -0.05 0.1") :]
        )
    found = retarget(parse_bvh(content.encode()), rig, slice(None))
    same_rotations(found.motion.poses, poses)


def test_parts_the_source_lacks_stay_straight(body, poses, roots):
    names = {part: name for part, name in MIXAMO.items() if part not in ("neck", "spine")}
    content = bvh_of(
        body.rig, names=names | {"neck": "Nape", "spine": "Waist"}, poses=poses, roots=roots
    )
    found = retarget(parse_bvh(content), body.rig, slice(None)).motion.poses
    assert np.abs(found[:, body.rig.index("neck")]).max() == 0.0
    chest = body.rig.index("chest")
    for pose, original in zip(found, poses, strict=True):
        np.testing.assert_allclose(
            global_rotations(pose, body.rig.part_parent)[chest],
            global_rotations(original, body.rig.part_parent)[chest],
            atol=1e-6,
        )


def test_a_person_of_other_size_walks_in_steps_of_its_own(body, poses, roots):
    smaller = packaged("male").rig
    content = bvh_of(body.rig, names=MIXAMO, poses=poses, roots=roots)
    found = retarget(parse_bvh(content), smaller, slice(None))

    def leg(rig):
        return sum(
            np.linalg.norm(rig.bone(f"{s}_{a}", f"{s}_{b}"))
            for s in ("left", "right")
            for a, b in (("thigh", "shin"), ("shin", "foot"))
        )

    assert found.scale == pytest.approx(leg(smaller) / leg(body.rig), rel=1e-6)


def test_the_clip_begins_facing_forward_above_the_origin(body, poses, roots):
    content = bvh_of(body.rig, names=MIXAMO, poses=poses[::-1], roots=roots + [3.0, 0.0, -2.0])
    motion = retarget(parse_bvh(content), body.rig, slice(1, None, 2)).motion
    forward = Rotation.from_rotvec(motion.poses[0, 0]).apply([0.0, 0.0, 1.0])
    assert abs(forward[0]) < 1e-6
    assert forward[2] > 0.0
    np.testing.assert_allclose(motion.roots[0, [0, 2]], 0.0, atol=1e-9)
    assert motion.frame_time_s == pytest.approx(2 / 30)


def test_a_jump_is_told_from_walking(body, poses, roots):
    """Only what leaves the ground by more than steps do has a lift."""
    standing = np.repeat(named_pose(body.rig, "standing")[None], 20, axis=0)
    places = np.tile([0.0, 0.9, 0.0], (20, 1))
    places[10:13, 1] += [0.2, 0.3, 0.2]
    places[15, 1] += 0.03
    content = bvh_of(body.rig, names=MIXAMO, poses=standing, roots=places)
    lifts = retarget(parse_bvh(content), body.rig, slice(None)).motion.lifts_m
    np.testing.assert_allclose(lifts[10:13], [0.15, 0.25, 0.15], atol=1e-6)
    assert (np.delete(lifts, [10, 11, 12]) == 0.0).all()


@pytest.mark.parametrize(("part", "name"), [("pelvis", "Middle"), ("left_thigh", "Peg")])
def test_a_skeleton_without_hips_or_legs_is_refused_by_what_it_lacks(
    body, poses, roots, part, name
):
    content = bvh_of(body.rig, names=MIXAMO | {part: name}, poses=poses, roots=roots)
    with pytest.raises(InvalidInputError) as caught:
        retarget(parse_bvh(content), body.rig, slice(None))
    assert caught.value.code == "bvh-skeleton-unknown"
    assert part in caught.value.reason
    assert "Mixamo" in caught.value.reason


def test_a_skeleton_that_lies_in_one_point_is_refused(body, poses, roots):
    content = bvh_of(body.rig, names=MIXAMO, poses=poses, roots=roots, unit_m=1e12)
    with pytest.raises(InvalidInputError) as caught:
        retarget(parse_bvh(content), body.rig, slice(None))
    assert caught.value.code == "bvh-skeleton-unknown"


def test_hips_in_another_unit_than_the_bones_are_refused(body, poses, roots):
    content = bvh_of(body.rig, names=MIXAMO, poses=poses, roots=1e4 * roots)
    with pytest.raises(InvalidInputError) as caught:
        retarget(parse_bvh(content), body.rig, slice(None))
    assert caught.value.code == "bvh-too-far"


@needs_shared(CLIP)
def test_a_real_clip_moves_hands_and_feet_as_its_own_skeleton_does(body):
    """In lengths of a limb, ours are where the source's are, but for proportions."""
    clip = parse_bvh(CLIP.read_bytes())
    found = retarget(clip, body.rig, slice(0, None, 40))
    assert found.naming == "CMU"
    _, positions = clip.motion(slice(0, None, 40))
    assert len(positions) == len(found.motion.poses)
    assert np.isfinite(found.motion.poses).all()
    names = list(clip.names)
    for frame, pose in enumerate(found.motion.poses):
        ours = posed_joints(
            body.rig.rest_joints,
            global_rotations(pose, body.rig.part_parent),
            body.rig.part_parent,
        )
        for part, end, joint, joint_end in (
            ("left_upper_arm", "left_forearm", "LeftShoulder", "LeftElbow"),
            ("right_forearm", "right_hand", "RightElbow", "RightWrist"),
            ("left_thigh", "left_shin", "LeftHip", "LeftKnee"),
            ("right_shin", "right_foot", "RightKnee", "RightAnkle"),
        ):
            bone = ours[body.rig.index(end)] - ours[body.rig.index(part)]
            source = positions[frame, names.index(joint_end)] - positions[frame, names.index(joint)]
            # The clip is turned to face forward: heights do not change by it.
            assert bone[1] / np.linalg.norm(bone) == pytest.approx(
                source[1] / np.linalg.norm(source), abs=1e-6
            )
