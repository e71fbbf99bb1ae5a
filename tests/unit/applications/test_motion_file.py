from pathlib import Path

import numpy as np
import pytest

from fitter.applications.motion_file import read_motion
from fitter.applications.poses import named_pose
from fitter.errors import InvalidInputError
from tests.unit.applications.bodies import packaged
from tests.unit.applications.bvh_files import MIXAMO, bvh_of

DATA = Path(__file__).with_name("data") / "bvh"


@pytest.fixture(scope="module")
def rig():
    return packaged("female").rig


def standing(rig, *, frames: int = 30, roots=None, **changes) -> bytes:
    poses = np.repeat(named_pose(rig, "standing")[None], frames, axis=0)
    roots = np.tile([0.0, 0.9, 0.0], (frames, 1)) if roots is None else roots
    return bvh_of(rig, names=MIXAMO, poses=poses, roots=roots, **changes)


def refusal(content: bytes, **told) -> InvalidInputError:
    with pytest.raises(InvalidInputError) as caught:
        read_motion(content, **told)
    return caught.value


def test_the_leg_is_as_long_whatever_the_rest_pose(rig):
    found = [read_motion(path.read_bytes()).leg for path in sorted(DATA.glob("r_*.bvh"))]
    assert len(found) == 3
    assert found == pytest.approx([found[0]] * 3, rel=1e-6)
    leg = sum(
        np.linalg.norm(rig.bone("left_" + above, "left_" + below))
        for above, below in (("thigh", "shin"), ("shin", "foot"))
    )
    assert read_motion(standing(rig, unit_m=0.01)).leg == pytest.approx(100 * leg, rel=1e-6)


def test_a_skeleton_that_lies_in_one_point_is_refused(rig):
    error = refusal(standing(rig, unit_m=1e12))
    assert error.code == "bvh-skeleton-unknown"
    assert "no length" in error.reason


def test_legs_that_do_not_hang_together_are_refused(rig):
    error = refusal(
        standing(rig),
        named={"left_shin": "mixamorig:RightLeg", "left_foot": "mixamorig:RightFoot"},
    )
    assert error.code == "bvh-skeleton-unknown"
    assert "left shin" in error.reason


def test_hips_in_another_unit_than_the_bones_are_refused(rig):
    roots = np.linspace([0.0, 0.9, 0.0], [0.0, 0.9, 1e4], 30)
    error = refusal(standing(rig, roots=roots))
    assert error.code == "bvh-too-far"
    # Where the world has its origin is another matter.
    read_motion(standing(rig, roots=np.tile([1e5, 0.9, -1e6], (30, 1))))


def test_a_bone_in_another_unit_is_refused(rig):
    content = standing(rig).decode().replace("OFFSET 0.0 -0.05 0.1", "OFFSET 0.0 -5000 0.1", 1)
    assert refusal(content.encode()).code == "bvh-too-far"


@pytest.mark.parametrize("start_s", [-0.1, 1.0, 1e9, float("nan")])
def test_a_stretch_outside_the_clip_is_refused(rig, start_s):
    error = refusal(standing(rig), start_s=start_s)
    assert (error.code, error.field) == ("stretch-outside-clip", "start_s")
    assert "1.00 s long" in error.reason


def test_a_stretch_begins_at_the_nearest_frame(rig):
    assert read_motion(standing(rig), start_s=0.51).first == 15
