"""Files of motion: BVH as it is read, whose skeletons are known, and what is refused."""

import codecs

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from fitter.applications import bvh
from fitter.applications.bvh import read_bvh
from fitter.applications.motion_file import (
    NEEDED,
    PARTS,
    REQUEST,
    joints_of_parts,
    plain_name,
)
from fitter.applications.retarget import Stretch, stretch_of
from fitter.errors import InvalidInputError
from tests.unit.applications.bodies import packaged

ARM = """\
HIERARCHY
ROOT Hips
{
  OFFSET 0 1 0
  CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation
  JOINT Arm
  {
    OFFSET 2 0 0
    CHANNELS 3 Yrotation Zrotation Xrotation
    End Site
    {
      OFFSET 0 0 3
    }
  }
}
MOTION
Frames: 2
Frame Time: 0.04
1 2 3 0 0 0 0 0 0
4 5 6 10 20 30 40 50 60
"""


def refusal(content: str | bytes) -> InvalidInputError:
    with pytest.raises(InvalidInputError) as caught:
        read_bvh(content if isinstance(content, bytes) else content.encode())
    assert caught.value.field == "bvh"
    assert caught.value.remedy.endswith(".")
    return caught.value


def moved(content: str, *frames: int) -> Stretch:
    return stretch_of(read_bvh(content.encode()), np.array(frames))


def test_a_small_file_is_read_as_written():
    clip = read_bvh(ARM.encode())
    assert clip.names == ("Hips", "Arm")
    assert clip.parents == (-1, 0)
    assert clip.offsets == ((0, 1, 0), (2, 0, 0))
    assert clip.ends == ((0, 0, 3),)
    assert clip.end_parents == (1,)
    assert (clip.frames, clip.frame_time_s) == (2, 0.04)
    assert clip.numbers.tolist() == [1, 2, 3, 0, 0, 0, 0, 0, 0, 4, 5, 6, 10, 20, 30, 40, 50, 60]
    assert clip.warnings == ()


def test_euler_angles_are_intrinsic_in_the_order_listed():
    found = moved(ARM, 0, 1)
    hips = Rotation.from_euler("ZXY", [10, 20, 30], degrees=True)
    arm = hips * Rotation.from_euler("YZX", [40, 50, 60], degrees=True)
    np.testing.assert_allclose(found.rotations[1, 0], hips.as_matrix(), atol=1e-12)
    np.testing.assert_allclose(found.rotations[1, 1], arm.as_matrix(), atol=1e-12)
    np.testing.assert_allclose(found.positions[1, 0], [4, 5, 6])
    place = [4, 5, 6] + hips.apply([2, 0, 0])
    np.testing.assert_allclose(found.positions[1, 1], place, atol=1e-12)
    np.testing.assert_allclose(found.ends[1, 0], place + arm.apply([0, 0, 3]), atol=1e-12)
    np.testing.assert_array_equal(found.rotations[0], np.tile(np.eye(3), (2, 1, 1)))


def test_whole_turns_make_no_difference_however_many():
    turned = ARM.replace("10 20 30 40 50 60", "370 -340 36000030 40 50 -300")
    np.testing.assert_allclose(moved(turned, 1).rotations, moved(ARM, 1).rotations, atol=1e-7)


@pytest.mark.parametrize("order", ["XYZ", "XZY", "YXZ", "YZX", "ZXY", "ZYX"])
def test_any_order_of_channels_is_understood(order):
    listed = " ".join(f"{axis}rotation" for axis in order)
    content = ARM.replace("Yrotation Zrotation Xrotation", listed)
    rotations = moved(content, 1).rotations
    local = rotations[0, 0].T @ rotations[0, 1]
    expected = Rotation.from_euler(order, [40, 50, 60], degrees=True).as_matrix()
    np.testing.assert_allclose(local, expected, atol=1e-12)


def test_some_frames_are_the_same_as_in_the_whole():
    whole, some = moved(ARM, 0, 1), moved(ARM, 1)
    np.testing.assert_array_equal(whole.rotations[1:], some.rotations)
    np.testing.assert_array_equal(whole.positions[1:], some.positions)


@pytest.mark.parametrize(
    "content",
    [
        ARM.replace("\n", "\r\n\r\n").replace("OFFSET", "Offset").replace("MOTION", "Motion"),
        ARM.replace("\n  {\n", " {\n").replace("{\n    OFFSET", "{ OFFSET"),
        "\n\n" + ARM.replace(" ", "\t"),
    ],
    ids=["Windows, small letters and blank lines", "braces within lines", "tabs"],
)
def test_other_layouts_of_the_same_words_are_read_without_a_word(content):
    found, expected = read_bvh(content.encode()), read_bvh(ARM.encode())
    assert (found.offsets, found.numbers) == (expected.offsets, expected.numbers)
    assert found.warnings == ()


@pytest.mark.parametrize(
    "content",
    [
        codecs.BOM_UTF8 + ARM.encode(),
        codecs.BOM_UTF16_LE + ARM.encode("utf-16-le"),
        codecs.BOM_UTF16_BE + ARM.encode("utf-16-be"),
    ],
)
def test_a_byte_order_mark_is_read(content):
    found = read_bvh(content)
    assert (found.names, found.frames, found.warnings) == (("Hips", "Arm"), 2, ())


LAST = "4 5 6 10 20 30 40 50 60"


@pytest.mark.parametrize(
    ("content", "frames", "told"),
    [
        (ARM.replace("Frames: 2", "Frames:2"), 2, "Line 17"),
        (ARM.replace("Frame Time: 0.04", "Frame Time:0.04"), 2, "Line 18"),
        (ARM.replace(LAST, "4 5 6\n10 20 30\n\n40 50 60"), 2, "Line 20"),
        (ARM.replace("Frames: 2", "Frames: 1"), 2, "announces 1 frames and has 2"),
        (ARM.replace("Frames: 2", "Frames: 3"), 2, "announces 3 frames and has 2"),
    ],
)
def test_what_a_file_says_against_itself_or_oddly_is_read_with_a_warning(content, frames, told):
    found = read_bvh(content.encode())
    assert found.frames == frames
    assert found.numbers == read_bvh(ARM.encode()).numbers
    (warning,) = found.warnings
    assert warning.code == "bvh-irregular"
    assert told in warning.reason


@pytest.mark.parametrize(
    "numbers",
    [LAST.replace("60", "60 70"), "4 5 6\n10 20 30 40 50 60 70", f"{LAST} {LAST}", "4 5 6\n10 20"],
)
def test_a_frame_ends_where_a_line_ends(numbers):
    assert "Line 20: frame 2 is not 9" in refusal(ARM.replace(LAST, numbers)).reason


@pytest.mark.parametrize(
    ("old", "new", "line", "word"),
    [
        ("ROOT Hips", "JOINT Hips", 2, "ROOT"),
        ("OFFSET 0 1 0", "OFFSET 0 1", 4, "three numbers"),
        ("OFFSET 0 1 0", "OFFSET 0 one 0", 4, "three numbers"),
        ("OFFSET 0 1 0", "OFFSET 0 nan 0", 4, "finite"),
        ("CHANNELS 6", "CHANNELS 5", 5, "5 different channels"),
        ("CHANNELS 3 Yrotation", "CHANNELS 3 Wrotation", 9, "Xrotation"),
        ("CHANNELS 3 Yrotation", "CHANNELS 3 Zrotation", 9, "different channels"),
        ("JOINT Arm", "JOINT Hips", 9, "second joint"),
        ("JOINT Arm", "BONE Arm", 6, "JOINT"),
        ("MOTION", "Frames: 2", 16, "MOTION"),
        ("Frames: 2", "Frames: two", 17, "whole number"),
        ("Frames: 2", "Frames: 0", 17, "0 frames"),
        ("Frames: 2", "Frames 2", 17, "Frames:"),
        ("Frame Time: 0.04", "Frame Time: 0", 18, "seconds"),
        ("Frame Time: 0.04", "Frame Time: 1e-6", 18, "seconds"),
        ("Frame Time: 0.04", "Frame Time: 11", 18, "seconds"),
        ("Frame Time: 0.04", "Frame Time: nan", 18, "seconds"),
        ("Frame Time: 0.04", "Frame Time: soon", 18, "seconds"),
        ("4 5 6 10", "4 5 6 nan", 20, "finite"),
        ("4 5 6 10", "4 5 6 1e200", 20, "finite"),
        ("OFFSET 0 1 0", "OFFSET 0 1e10 0", 4, "1e9"),
        ("4 5 6 10", "4 5 6 ten", 20, "finite"),
        ("4 5 6 10", "4 5 10", 20, "8 words"),
    ],
)
def test_what_is_wrong_is_told_by_its_line(old, new, line, word):
    error = refusal(ARM.replace(old, new, 1))
    assert error.code == "bvh-unreadable"
    assert f"Line {line}:" in error.reason
    assert word in error.reason


def test_missing_frames_are_counted():
    assert "after 2 of the 4 frames" in refusal(ARM.replace("Frames: 2", "Frames: 4")).reason
    more = ARM + f"{LAST}\n" * 2
    assert "Line 22: more frames than the 2" in refusal(more).reason


@pytest.mark.parametrize(
    "content", [b"", b"hello\nROOT Hips", b"\n\n", bytes(range(256)), b"\x89PNG\r\n\x1a\n" * 9]
)
def test_what_is_no_text_of_this_kind_is_no_bvh(content):
    error = refusal(content)
    assert error.code == "not-a-bvh"
    assert "HIERARCHY" in error.reason


@pytest.mark.parametrize("cut", range(40, len(ARM) - 30, 37))
def test_a_file_cut_anywhere_is_refused(cut):
    assert refusal(ARM[:cut]).code == "bvh-unreadable"


def test_a_million_frames_are_refused_before_they_are_read():
    error = refusal(ARM.replace("Frames: 2", "Frames: 1000000"))
    assert error.code == "bvh-too-long"
    assert "1000000" in error.reason


def test_a_huge_file_is_refused_unread():
    assert refusal(b" " * (bvh.MAX_BYTES + 1)).code == "bvh-too-large"


def test_a_skeleton_without_end_of_joints_is_refused():
    joints = "".join(
        f"JOINT J{k}\n{{\nOFFSET 0 0 0\nCHANNELS 0\n" for k in range(bvh.MAX_JOINTS + 1)
    )
    head, _, _ = ARM.partition("  JOINT Arm")
    assert refusal(head + joints).code == "bvh-too-large"


LIMBS = ("upper_arm", "forearm", "hand", "thigh", "shin", "foot")

FAMILIES = {
    "CMU": "Hips lowerback Chest Neck Head / LeftShoulder LeftElbow LeftWrist LeftHip LeftKnee "
    "LeftAnkle",
    "Mixamo": "mixamorig:Hips mixamorig:Spine mixamorig:Spine2 mixamorig:Neck mixamorig:Head / "
    "mixamorig:LeftArm mixamorig:LeftForeArm mixamorig:LeftHand mixamorig:LeftUpLeg "
    "mixamorig:LeftLeg mixamorig:LeftFoot",
    "SMPL": "Pelvis Spine1 Spine3 Neck Head / L_Shoulder L_Elbow L_Wrist L_Hip L_Knee L_Ankle",
    "3ds Max Biped": "Bip01~Pelvis Bip01~Spine Bip01~Spine1 Bip01~Neck Bip01~Head / "
    "Bip01~L~UpperArm Bip01~L~Forearm Bip01~L~Hand Bip01~L~Thigh Bip01~L~Calf Bip01~L~Foot",
    "Blender Rigify": "DEF-spine DEF-spine.001 DEF-spine.003 DEF-spine.004 DEF-spine.006 / "
    "DEF-upper_arm.L DEF-forearm.L DEF-hand.L DEF-thigh.L DEF-shin.L DEF-foot.L",
    "OptiTrack": "Hip Ab Chest Neck Head / LUArm LFArm LHand LThigh LShin LFoot",
}
"""One of each manner of naming: sides spelt out, prefixes, letters before and behind, blanks."""

RIGHT = (("Left", "Right"), ("~L~", "~R~"), (".L", ".R"))


def joints(line: str) -> dict[str, str]:
    """By part, from names of the trunk and the left limbs."""
    trunk, left = (half.split() for half in line.split(" / "))
    names: dict[str, str] = {}
    names.update(zip(("pelvis", "spine", "chest", "neck", "head"), trunk, strict=True))
    for limb, name in zip(LIMBS, left, strict=True):
        names[f"left_{limb}"] = name.replace("~", " ")
        names[f"right_{limb}"] = right(name).replace("~", " ")
    return {part: name.replace("~", " ") for part, name in names.items()}


def right(name: str) -> str:
    for ours, theirs in RIGHT:
        if ours in name:
            return name.replace(ours, theirs)
    if name.lower().endswith("_l"):
        return name[:-1] + ("R" if name[-1] == "L" else "r")
    return ("R" if name[0] == "L" else "r") + name[1:]


@pytest.mark.parametrize(
    ("family", "line"),
    FAMILIES.items(),
    ids=FAMILIES,
)
def test_a_skeleton_is_known_by_the_names_of_its_program(family, line):
    names = joints(line)
    order = sorted(names.values())
    naming, found = joints_of_parts(order)
    assert naming == family
    assert {part: order[joint] for part, joint in found.items()} == names


def test_the_parts_are_those_of_the_body():
    assert set(PARTS) == set(packaged("female").model.part_names)


def test_names_are_read_without_namespace_prefix_case_and_punctuation():
    assert plain_name("Armature:mixamorig1:LeftUpLeg") == "leftupleg"
    assert plain_name("Character1_LeftHand") == plain_name("left.hand") == "lefthand"


OWN = {part: f"Teil {number}" for number, part in enumerate(NEEDED)}


def test_joints_that_are_told_need_no_known_names():
    names = list(OWN.values())
    naming, found = joints_of_parts(names, OWN)
    assert naming == REQUEST
    assert {part: names[joint] for part, joint in found.items()} == OWN


def test_joints_that_are_told_are_taken_before_those_that_are_known():
    names = joints(FAMILIES["Mixamo"])
    odd = [*(name for part, name in names.items() if part != "left_foot"), "Peg", "Twist"]
    naming, found = joints_of_parts(odd, {"left_foot": "Peg", "left_thigh": "Twist"})
    assert naming == "Mixamo"
    assert (odd[found["left_foot"]], odd[found["left_thigh"]]) == ("Peg", "Twist")
    assert odd[found["right_thigh"]] == names["right_thigh"]


def refused_names(names, named=None) -> InvalidInputError:
    with pytest.raises(InvalidInputError) as caught:
        joints_of_parts(names, named)
    return caught.value


@pytest.mark.parametrize("part", ["pelvis", "left_thigh"])
def test_a_skeleton_without_hips_or_legs_is_refused_by_what_it_lacks(part):
    names = joints(FAMILIES["Mixamo"]) | {part: "Peg"}
    error = refused_names(list(names.values()))
    assert (error.code, error.field) == ("bvh-skeleton-unknown", "bvh")
    assert f"almost as by Mixamo, but none is the person's {part}." in error.reason
    assert "Peg" in error.reason
    assert f'`joints` which joint moves which part, such as {{"{part}"' in error.remedy
    assert all(family in error.remedy for family in FAMILIES)


def test_no_family_is_named_for_a_skeleton_that_is_like_none():
    error = refused_names(["Hips", "Bein links", "Bein rechts", *(f"Glied {k}" for k in range(60))])
    assert not any(family in error.reason for family in FAMILIES)
    assert all(part in error.reason for part in NEEDED if part != "pelvis")
    assert "Glied 36 and 23 more" in error.reason


@pytest.mark.parametrize(
    ("named", "code", "told"),
    [
        ({"tail": "Teil 1"}, "part-unknown", "left_upper_arm"),
        ({"left_foot": "Peg"}, "bvh-skeleton-unknown", "Teil 12"),
    ],
)
def test_what_is_told_is_of_the_body_and_of_the_file(named, code, told):
    error = refused_names(list(OWN.values()), OWN | named)
    assert (error.code, error.field) == (code, f"joints.{next(iter(named))}")
    assert told in error.reason + error.remedy
