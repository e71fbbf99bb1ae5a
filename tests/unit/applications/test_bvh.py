import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from fitter.applications import bvh
from fitter.applications.bvh import BvhClip, parse_bvh
from fitter.errors import InvalidInputError

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
        parse_bvh(content if isinstance(content, bytes) else content.encode())
    assert caught.value.field == "bvh"
    assert caught.value.remedy.endswith(".")
    return caught.value


def test_a_small_file_is_read_as_written():
    clip = parse_bvh(ARM.encode())
    assert clip.names == ("Hips", "Arm")
    assert clip.parent.tolist() == [-1, 0]
    assert clip.offsets.tolist() == [[0, 1, 0], [2, 0, 0]]
    assert clip.ends.tolist() == [[0, 0, 3]]
    assert clip.end_parent.tolist() == [1]
    assert clip.frame_time_s == 0.04
    np.testing.assert_array_equal(clip.rest_positions(), [[0, 1, 0], [2, 1, 0]])


def test_euler_angles_are_intrinsic_in_the_order_listed():
    rotations, positions = parse_bvh(ARM.encode()).motion(slice(None))
    hips = Rotation.from_euler("ZXY", [10, 20, 30], degrees=True)
    arm = hips * Rotation.from_euler("YZX", [40, 50, 60], degrees=True)
    np.testing.assert_allclose(rotations[1, 0], hips.as_matrix(), atol=1e-12)
    np.testing.assert_allclose(rotations[1, 1], arm.as_matrix(), atol=1e-12)
    np.testing.assert_allclose(positions[1, 0], [4, 5, 6])
    np.testing.assert_allclose(positions[1, 1], [4, 5, 6] + hips.apply([2, 0, 0]), atol=1e-12)
    np.testing.assert_array_equal(rotations[0], np.tile(np.eye(3), (2, 1, 1)))


def test_whole_turns_make_no_difference_however_many():
    turned = ARM.replace("10 20 30 40 50 60", "370 -340 36000030 40 50 -300")
    found, _ = parse_bvh(turned.encode()).motion(slice(1, 2))
    expected, _ = parse_bvh(ARM.encode()).motion(slice(1, 2))
    np.testing.assert_allclose(found, expected, atol=1e-7)


@pytest.mark.parametrize("order", ["XYZ", "XZY", "YXZ", "YZX", "ZXY", "ZYX"])
def test_any_order_of_channels_is_understood(order):
    listed = " ".join(f"{axis}rotation" for axis in order)
    content = ARM.replace("Yrotation Zrotation Xrotation", listed)
    clip = parse_bvh(content.encode())
    rotations, _ = clip.motion(slice(1, 2))
    local = rotations[0, 0].T @ rotations[0, 1]
    expected = Rotation.from_euler(order, [40, 50, 60], degrees=True).as_matrix()
    np.testing.assert_allclose(local, expected, atol=1e-12)


def test_some_frames_are_the_same_as_in_the_whole():
    clip = parse_bvh(ARM.encode())
    for whole, some in zip(clip.motion(slice(None)), clip.motion(slice(1, 2)), strict=True):
        np.testing.assert_array_equal(whole[1:], some)


def test_windows_line_ends_small_letters_and_blank_lines_do_no_harm():
    content = ARM.replace("\n", "\r\n\r\n").replace("OFFSET", "Offset").replace("MOTION", "Motion")
    assert isinstance(parse_bvh(content.encode()), BvhClip)


@pytest.mark.parametrize(
    ("old", "new", "line", "word"),
    [
        ("HIERARCHY", "hello", 1, "HIERARCHY"),
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
        ("Frames: 2", "Frames: 1", 20, "announced"),
        ("Frame Time: 0.04", "Frame Time: 0", 18, "seconds"),
        ("Frame Time: 0.04", "Frame Time: 1e-320", 18, "seconds"),
        ("Frame Time: 0.04", "Frame Time: 1e-6", 18, "seconds"),
        ("Frame Time: 0.04", "Frame Time: 11", 18, "seconds"),
        ("Frame Time: 0.04", "Frame Time: nan", 18, "seconds"),
        ("Frame Time: 0.04", "Frame Time: soon", 18, "seconds"),
        ("4 5 6 10", "4 5 6 nan", 20, "finite"),
        ("4 5 6 10", "4 5 6 1e400", 20, "finite"),
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
    assert "after 2 of the 3 frames" in refusal(ARM.replace("Frames: 2", "Frames: 3")).reason


@pytest.mark.parametrize("content", [b"", b"\n\n", bytes(range(256)), b"\x89PNG\r\n\x1a\n" * 9])
def test_what_is_no_text_of_this_kind_is_no_bvh(content):
    assert "HIERARCHY" in refusal(content).reason


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
