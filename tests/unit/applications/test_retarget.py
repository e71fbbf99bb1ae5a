"""A motion of another skeleton on the person's own, whatever the file calls rest, up and a unit."""

from itertools import cycle
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from fitter.applications.motion import MovingBody, grounded, motion_of_cycle, moving_body, sliding_m
from fitter.applications.motion_file import read_motion
from fitter.applications.poses import NAMED_POSES, named_pose
from fitter.applications.retarget import AXES, Retargeted, found_up_axis, given_up_axis, retarget
from fitter.applications.walk import stride_of
from fitter.body.model import global_rotations, posed_joints
from fitter.errors import InvalidInputError
from tests.unit.applications.bodies import packaged
from tests.unit.applications.bvh_files import MIXAMO, NAMES, bvh_of

DATA = Path(__file__).with_name("data") / "bvh"

Z_UP = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]])
BACK_TO_FRONT = np.diag([-1.0, 1.0, -1.0])
REST_POSES = ("r_identity", "r_restframe0", "r_lafanlike")


@pytest.fixture(scope="module")
def body():
    return packaged("female")


@pytest.fixture(scope="module")
def walking(body):
    """Two strides on the ground."""
    motion = motion_of_cycle(stride_of(body.rig), body.rig, frames=2 * stride_of(body.rig).frames)
    return grounded(moving_body(body.evaluator, body.shape, motion), body.model)


def retargeted(content: bytes, rig, *, first=0, step=1, up=None) -> Retargeted:
    source = read_motion(content)
    return retarget(source, rig, np.arange(first, source.clip.frames, step), up=up)


def written(body, walking: MovingBody, **changes) -> bytes:
    choices = {"names": MIXAMO, "poses": walking.motion.poses, "roots": walking.roots} | changes
    return bvh_of(body.rig, **choices)


def turned(rig, poses) -> np.ndarray:
    """(t, p, 3, 3) of the parts in the world."""
    return np.stack([global_rotations(pose, rig.part_parent) for pose in poses])


def apart_deg(rig, first: np.ndarray, second: np.ndarray) -> np.ndarray:
    """(t, p) between the parts of two motions' poses."""
    between = np.swapaxes(turned(rig, first), -1, -2) @ turned(rig, second)
    angles = Rotation.from_matrix(between.reshape(-1, 3, 3)).magnitude()
    return np.degrees(angles).reshape(first.shape[:2])


def joints(rig, poses) -> np.ndarray:
    """(t, p, 3) with the pelvis at the origin."""
    return np.stack(
        [
            posed_joints(rig.rest_joints, global_rotations(pose, rig.part_parent), rig.part_parent)
            for pose in poses
        ]
    )


def test_one_motion_gives_one_film_whatever_its_file_calls_rest(body):
    """As exported, the first frame, and every bone along +x; files have six decimals."""
    films = []
    for name in REST_POSES:
        motion = retargeted((DATA / f"{name}.bvh").read_bytes(), body.rig, step=4).motion
        films.append(grounded(moving_body(body.evaluator, body.shape, motion), body.model))
    places = [joints(body.rig, film.motion.poses) + film.roots[:, None] for film in films]
    slid = [sliding_m(film, body.model) for film in films]
    for film, place, each in zip(films[1:], places[1:], slid[1:], strict=True):
        np.testing.assert_allclose(place, places[0], atol=2e-6)
        assert each == pytest.approx(slid[0], abs=2e-6)
        for frame in (0, len(place) - 1):
            np.testing.assert_allclose(film.vertices(frame), films[0].vertices(frame), atol=1e-5)
    # And nobody lies on the floor.
    head = body.rig.index("head")
    assert np.median(places[0][:, head, 1]) > 1.2


@settings(max_examples=12, deadline=None)
@given(seed=st.integers(0, 2**32 - 1))
def test_turning_the_frames_of_the_joints_changes_nothing(seed):
    """By anything, each by its own: offsets and rotations say the same positions."""
    body = packaged("female")
    poses = np.stack([named_pose(body.rig, name) for name in NAMED_POSES])
    roots = np.tile([0.0, 0.9, 0.0], (len(poses), 1))
    random = np.random.default_rng(seed)
    turns = {part: Rotation.random(rng=random).as_matrix() for part in body.rig.part_names}
    expected, found = (
        retargeted(
            bvh_of(body.rig, names=MIXAMO, poses=poses, roots=roots, rest_turns=rest), body.rig
        ).motion
        for rest in (None, turns)
    )
    assert apart_deg(body.rig, expected.poses, found.poses).max() < 1e-4
    np.testing.assert_allclose(found.roots, expected.roots, atol=1e-6)


@pytest.mark.parametrize(("program", "order"), [*zip(NAMES, cycle(["ZXY", "XYZ", "YZX"]))])
def test_names_and_orders_of_channels_do_not_matter(body, walking, program, order):
    expected = retargeted(written(body, walking), body.rig).motion
    content = written(body, walking, names=NAMES[program], order=order)
    assert read_motion(content).naming == program
    found = retargeted(content, body.rig)
    assert found.scale == pytest.approx(1.0, abs=1e-6)
    assert apart_deg(body.rig, expected.poses, found.motion.poses).max() < 1e-4


@pytest.mark.parametrize(
    ("axes", "up"),
    [(np.eye(3), "y"), (Z_UP, "z"), (BACK_TO_FRONT, "y"), (Z_UP @ BACK_TO_FRONT, "z")],
)
def test_neither_axes_nor_unit_of_the_file_matter(body, walking, axes, up):
    expected = retargeted(written(body, walking), body.rig).motion
    content = written(body, walking, axes=axes, unit_m=0.01)
    found = retargeted(content, body.rig)
    assert found.up.axis == up
    assert len(found.up.warnings) == (up != "y")
    assert found.scale == pytest.approx(0.01, rel=1e-6)
    told = retargeted(content, body.rig, up=up)
    assert told.up.warnings == ()
    for motion in (found.motion, told.motion):
        assert apart_deg(body.rig, expected.poses, motion.poses).max() < 1e-4
        np.testing.assert_allclose(motion.roots, expected.roots, atol=1e-6)


def test_a_person_who_lies_is_laid_down_where_up_is_told(body):
    poses = np.repeat(named_pose(body.rig, "standing")[None], 5, axis=0)
    poses[:, 0] = [-1.5, 0.0, 0.0]
    content = bvh_of(body.rig, names=MIXAMO, poses=poses, roots=np.tile([0.0, 0.1, 0.0], (5, 1)))
    taken = retargeted(content, body.rig)
    assert taken.up.axis != "y"
    assert [warning.code for warning in taken.up.warnings] == ["up-uncertain"]
    found = retargeted(content, body.rig, up="y")
    head = joints(body.rig, found.motion.poses)[:, body.rig.index("head")]
    assert np.abs(head[:, 1]).max() < 0.2
    assert found.up.warnings == ()


def test_bones_of_limbs_point_where_the_sources_do(body, walking):
    found = retargeted(written(body, walking), body.rig).motion
    ours, theirs = joints(body.rig, found.poses), joints(body.rig, walking.motion.poses)
    # The clip is turned to face forward: heights do not change by it.
    for side in ("left", "right"):
        for part, end in (
            *(("upper_arm", "forearm"), ("forearm", "hand"), ("thigh", "shin"), ("shin", "foot")),
        ):
            a, b = (body.rig.index(f"{side}_{limb}") for limb in (part, end))
            np.testing.assert_allclose(
                ours[:, b, 1] - ours[:, a, 1], theirs[:, b, 1] - theirs[:, a, 1], atol=1e-6
            )


@pytest.mark.parametrize("gender", ["female", "male"])
def test_a_walk_comes_back_nearly_as_it_was(gender):
    """What cannot be seen of joints' positions is taken from how people stand and walk."""
    body = packaged(gender)
    motion = motion_of_cycle(stride_of(body.rig), body.rig, frames=2 * stride_of(body.rig).frames)
    made = grounded(moving_body(body.evaluator, body.shape, motion), body.model)
    found = retargeted(written(body, made), body.rig).motion
    apart = apart_deg(body.rig, motion.poses, found.poses)
    assert dict(zip(body.rig.part_names, apart.mean(axis=0) < 10.0, strict=True)) == dict.fromkeys(
        body.rig.part_names, True
    )
    assert apart.mean() < 5.0


def test_every_stretch_of_a_clip_shows_the_same(body, walking):
    content = written(body, walking)
    whole = retargeted(content, body.rig).motion
    part = retargeted(content, body.rig, first=20).motion
    np.testing.assert_allclose(part.poses[:, 1:], whole.poses[20:, 1:], atol=1e-9)


def test_parts_the_source_lacks_stay_straight(body, walking):
    names = MIXAMO | {"neck": "Nape", "spine": "Waist"}
    found = retargeted(written(body, walking, names=names), body.rig).motion.poses
    assert np.abs(found[:, body.rig.index("neck")]).max() == 0.0
    assert np.abs(found[:, body.rig.index("spine")]).max() == 0.0
    complete = retargeted(written(body, walking), body.rig).motion.poses
    apart = apart_deg(body.rig, found, complete)
    others = [part for part in body.rig.part_names if part not in ("neck", "spine")]
    assert apart[:, [body.rig.index(part) for part in others]].max() < 1e-4


def test_a_person_of_other_size_walks_in_steps_of_its_own(body, walking):
    smaller = packaged("male").rig
    found = retargeted(written(body, walking), smaller)

    def leg(rig):
        return sum(
            np.linalg.norm(rig.bone(f"{s}_{a}", f"{s}_{b}"))
            for s in ("left", "right")
            for a, b in (("thigh", "shin"), ("shin", "foot"))
        )

    assert found.scale == pytest.approx(leg(smaller) / leg(body.rig), rel=1e-6)


def test_the_clip_begins_facing_forward_above_the_origin(body, walking):
    turn = Rotation.from_rotvec([0.0, 2.0, 0.0])
    poses = walking.motion.poses.copy()
    poses[:, 0] = (turn * Rotation.from_rotvec(poses[:, 0])).as_rotvec()
    roots = turn.apply(walking.roots) + [3.0, 0.0, -2.0]
    content = written(body, walking, poses=poses, roots=roots)
    motion = retargeted(content, body.rig, first=1, step=2).motion
    forward = Rotation.from_rotvec(motion.poses[0, 0]).apply([0.0, 0.0, 1.0])
    assert abs(forward[0]) < 1e-6
    assert forward[2] > 0.0
    np.testing.assert_allclose(motion.roots[0, [0, 2]], 0.0, atol=1e-9)
    assert motion.roots[-1, 2] > 1.0
    assert motion.frame_time_s == pytest.approx(2 / 30)


def test_a_jump_is_told_from_walking(body):
    """Only what leaves the ground by more than steps do has a lift."""
    standing = np.repeat(named_pose(body.rig, "standing")[None], 20, axis=0)
    places = np.tile([0.0, 0.9, 0.0], (20, 1))
    places[10:13, 1] += [0.2, 0.3, 0.2]
    places[15, 1] += 0.03
    content = bvh_of(body.rig, names=MIXAMO, poses=standing, roots=places)
    lifts = retargeted(content, body.rig).motion.lifts_m
    np.testing.assert_allclose(lifts[10:13], [0.15, 0.25, 0.15], atol=1e-6)
    assert (np.delete(lifts, [10, 11, 12]) == 0.0).all()


def test_a_file_whose_world_lies_far_from_its_origin_loses_nothing(body, walking):
    near, far = (
        retargeted(written(body, walking, roots=walking.roots + place), body.rig).motion
        for place in (0.0, [3e5, 0.0, -2e5])
    )
    np.testing.assert_allclose(far.roots, near.roots, atol=1e-6)
    np.testing.assert_allclose(far.lifts_m, near.lifts_m, atol=1e-6)


def test_limbs_without_length_do_no_harm(body, walking):
    """Hands on the elbows, hips and shoulders in one point: something finite comes of it."""
    content = written(body, walking).decode().splitlines()
    for number, line in enumerate(content):
        if "JOINT" in line and any(name in line for name in ("Arm", "Hand", "UpLeg", "Spine")):
            content[number + 2] = "OFFSET 0 0 0"
    motion = retargeted("\n".join(content).encode(), body.rig).motion
    assert np.isfinite(motion.poses).all()
    assert np.isfinite(motion.roots).all()
    between = turned(body.rig, motion.poses)
    np.testing.assert_allclose(np.linalg.det(between), 1.0, atol=1e-9)


DIRECTIONS = dict(
    zip(AXES, [[0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1], [1, 0, 0], [-1, 0, 0]], strict=True)
)


@pytest.mark.parametrize("axis", AXES)
def test_every_axis_is_turned_to_the_worlds_up_without_mirroring(axis):
    found = given_up_axis(axis)
    np.testing.assert_array_equal(found.to_world @ DIRECTIONS[axis], [0, 1, 0])
    np.testing.assert_allclose(found.to_world @ found.to_world.T, np.eye(3))
    assert np.linalg.det(found.to_world) == pytest.approx(1.0)
    assert (found.axis, found.warnings) == (axis, ())


def test_a_file_whose_y_is_up_stays_as_it_is():
    np.testing.assert_array_equal(given_up_axis("y").to_world, np.eye(3))


@pytest.mark.parametrize("axis", AXES)
def test_up_is_where_heads_are_above_feet(axis):
    sway = np.random.default_rng(0).normal(scale=0.2, size=(50, 3))
    found = found_up_axis(np.array(DIRECTIONS[axis]) + sway)
    assert found.axis == axis
    # Nearly all files have y up; one that has not is either made so, or of somebody who lies.
    assert [warning.code for warning in found.warnings] == ["up-uncertain"] * (axis != "y")


def test_a_dance_on_the_floor_does_not_hide_that_most_frames_are_upright():
    frames = np.array([[0.0, 1.0, 0.0]] * 60 + [[0.0, 0.0, 1.0]] * 40)
    found = found_up_axis(frames)
    assert found.axis == "y"
    (warning,) = found.warnings
    assert warning.code == "up-uncertain"
    assert "60%" in warning.reason
    assert "`up`" in warning.remedy


def test_a_body_without_extent_gives_an_axis_and_a_doubt():
    found = found_up_axis(np.zeros((3, 3)))
    assert found.axis == "y"
    assert len(found.warnings) == 1


def standing(rig, *, frames: int = 30, roots=None, **changes) -> bytes:
    poses = np.repeat(named_pose(rig, "standing")[None], frames, axis=0)
    roots = np.tile([0.0, 0.9, 0.0], (frames, 1)) if roots is None else roots
    return bvh_of(rig, names=MIXAMO, poses=poses, roots=roots, **changes)


def refused_motion(content: bytes, **told) -> InvalidInputError:
    with pytest.raises(InvalidInputError) as caught:
        read_motion(content, **told)
    return caught.value


def test_the_leg_is_as_long_whatever_the_rest_pose(body):
    found = [read_motion(path.read_bytes()).leg for path in sorted(DATA.glob("r_*.bvh"))]
    assert len(found) == 3
    assert found == pytest.approx([found[0]] * 3, rel=1e-6)
    leg = sum(
        np.linalg.norm(body.rig.bone("left_" + above, "left_" + below))
        for above, below in (("thigh", "shin"), ("shin", "foot"))
    )
    assert read_motion(standing(body.rig, unit_m=0.01)).leg == pytest.approx(100 * leg, rel=1e-6)


def test_a_skeleton_that_lies_in_one_point_is_refused(body):
    error = refused_motion(standing(body.rig, unit_m=1e12))
    assert error.code == "bvh-skeleton-unknown"
    assert "no length" in error.reason


def test_legs_that_do_not_hang_together_are_refused(body):
    error = refused_motion(
        standing(body.rig),
        named={"left_shin": "mixamorig:RightLeg", "left_foot": "mixamorig:RightFoot"},
    )
    assert error.code == "bvh-skeleton-unknown"
    assert "left shin" in error.reason


def test_hips_in_another_unit_than_the_bones_are_refused(body):
    roots = np.linspace([0.0, 0.9, 0.0], [0.0, 0.9, 1e4], 30)
    error = refused_motion(standing(body.rig, roots=roots))
    assert error.code == "bvh-too-far"
    # Where the world has its origin is another matter.
    read_motion(standing(body.rig, roots=np.tile([1e5, 0.9, -1e6], (30, 1))))


def test_a_bone_in_another_unit_is_refused(body):
    content = standing(body.rig).decode().replace("OFFSET 0.0 -0.05 0.1", "OFFSET 0.0 -5000 0.1", 1)
    assert refused_motion(content.encode()).code == "bvh-too-far"


@pytest.mark.parametrize("start_s", [-0.1, 1.0, 1e9, float("nan")])
def test_a_stretch_outside_the_clip_is_refused(body, start_s):
    error = refused_motion(standing(body.rig), start_s=start_s)
    assert (error.code, error.field) == ("stretch-outside-clip", "start_s")
    assert "1.00 s long" in error.reason


def test_a_stretch_begins_at_the_nearest_frame(body):
    assert read_motion(standing(body.rig), start_s=0.51).first == 15
