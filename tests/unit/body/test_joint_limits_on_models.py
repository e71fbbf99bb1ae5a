"""The joint limits on the trained bodies: where limbs point says what a person can do.

Poses are given by directions of bones, so nothing here knows of the limits' own axes.
"""

from functools import cache

import numpy as np
import pytest

from fitter.arrays import Pose
from fitter.body.joint_limits import LIMIT_SOFTNESS_DEG
from fitter.body.model import BodyModel, global_rotations, regress
from fitter.body.pose_prior import PosePrior, pose_prior, prior_residuals
from fitter.body.storage import load_body_model, packaged_model_path
from fitter.numerics.rotations import rotation_matrices
from fitter.training.articulation.poses import relative_pose, rotation_between

ADMITTED, REFUSED = 1.0, 20.0
"""Degrees beyond the limits at the worst joint."""

STRAIGHTENED = 6.0
"""The pose that height is measured in straightens elbows the shortest way, which no elbow takes."""

MIRROR = np.array([-1.0, 1.0, 1.0])
LIMBS = {"arm": ("upper_arm", "forearm", "hand"), "leg": ("thigh", "shin", "foot")}

Bones = tuple[tuple[float, float, float], tuple[float, float, float]]
"""Directions of a left limb's two bones in the body frame: to the left, up, ahead."""


class Rig:
    """A model's joints, and poses of it by directions."""

    def __init__(self, gender: str) -> None:
        self.model: BodyModel = load_body_model(packaged_model_path(gender))
        self.joints = regress(self.model.joint_regressor, self.model.mean_vertices)
        self.prior: PosePrior = pose_prior(
            self.model.part_names, self.model.part_parent, self.joints
        )

    def part(self, name: str) -> int:
        return self.model.part_names.index(name)

    def excess(self, pose: Pose) -> float:
        """Degrees by which a pose leaves the limits at its worst joint and direction."""
        return float(LIMIT_SOFTNESS_DEG * np.abs(prior_residuals(self.prior, pose)[:, 3:]).max())

    def posed(self, *, trunk: dict[str, tuple[float, float, float]] | None = None, **limbs: Bones):
        """Limbs (``arms``, ``left_leg``) along directions, trunk turned by degrees about x, y, z.

        A hinge bends as its bones say; the limb twists about its upper bone to let it.
        """
        turned = global_rotations(self.model.canonical_pose, self.model.part_parent)
        for name, bones in limbs.items():
            for side in ("left", "right") if name.endswith("s") else (name.split("_")[0],):
                limb = LIMBS[name.removesuffix("s").split("_")[-1]]
                self._aim(turned, side, limb, bones)
        pose = relative_pose(turned)
        for name, degrees in (trunk or {}).items():
            pose[self.part(name)] = np.radians(degrees)
        return pose

    def _aim(self, turned: np.ndarray, side: str, limb: tuple[str, ...], bones: Bones) -> None:
        first, second, third = (self.part(f"{side}_{name}") for name in limb)
        rest = [
            unit(self.joints[b] - self.joints[a]) for a, b in ((first, second), (second, third))
        ]
        mirror = np.ones(3) if side == "left" else MIRROR
        upper, lower = (unit(mirror * np.array(bone)) for bone in bones)
        hinge = (
            np.array([1.0, 0.0, 0.0]) if limb[0] == "thigh" else unit(np.cross(rest[0], rest[1]))
        )
        swing = rotation_between(rest[0], upper)
        bend = float(np.arccos(np.clip(upper @ lower, -1.0, 1.0)))
        if bend > np.radians(5.0):
            beside = np.cross(swing @ hinge, upper)
            wanted = lower - (lower @ upper) * upper
            twist = float(np.arctan2(np.cross(beside, wanted) @ upper, beside @ wanted))
            swing = about(upper, twist) @ swing
        turned[first] = swing
        straight = swing @ rotation_between(rest[1], rest[0])
        turned[second] = about(swing @ hinge, bend) @ straight
        turned[third] = turned[second]
        if limb[0] == "thigh":
            turned[third] = swing @ about(hinge, bend)


def unit(vector: np.ndarray) -> np.ndarray:
    return vector / np.linalg.norm(vector)


def about(axis: np.ndarray, angle: float) -> np.ndarray:
    return rotation_matrices((angle * unit(axis))[None])[0]


@cache
def rig_of(gender: str) -> Rig:
    return Rig(gender)


@pytest.fixture(params=["female", "male"])
def rig(request) -> Rig:
    return rig_of(request.param)


def possible(rig: Rig) -> dict[str, Pose]:
    down, ahead = (0.0, -1.0, 0.0), (0.0, 0.0, 1.0)
    return {
        "standing": rig.posed(arms=((0.2, -1.0, 0.0), (0.15, -1.0, 0.2)), legs=(down, down)),
        "canonical": rig.model.canonical_pose,
        "sitting": rig.posed(legs=((0.1, -0.1, 1.0), down), arms=((0.25, -1.0, 0.1), ahead)),
        "walking": rig.posed(
            left_leg=((0.05, -1.0, 0.5), (0.05, -1.0, 0.2)),
            right_leg=((0.05, -1.0, -0.2), (0.05, -1.0, -0.8)),
            left_arm=((0.2, -1.0, -0.4), (0.2, -1.0, -0.1)),
            right_arm=((0.2, -1.0, 0.4), (0.1, -1.0, 0.9)),
        ),
        "arms raised": rig.posed(arms=((0.2, 1.0, 0.1), (0.1, 1.0, 0.1))),
        "arms ahead": rig.posed(arms=((0.1, 0.0, 1.0), (0.05, 0.0, 1.0))),
        "T-pose": rig.posed(arms=((1.0, 0.0, 0.0), (1.0, 0.0, 0.0))),
        "arms crossed": rig.posed(arms=((0.2, -1.0, 0.5), (-1.0, 0.1, 0.45))),
        "hands on hips": rig.posed(arms=((0.8, -0.9, -0.2), (-0.8, -0.7, 0.5))),
        "hands at the head": rig.posed(arms=((0.9, 0.5, 0.3), (-0.6, 0.9, 0.0))),
        "squatting": rig.posed(legs=((0.4, 0.2, 1.0), (0.0, -1.0, -0.3))),
        "looking over a shoulder": rig.posed(
            trunk={"neck": (0.0, 35.0, 0.0), "head": (0.0, 35.0, 0.0), "chest": (0.0, 20.0, 0.0)}
        ),
        "bent forward": rig.posed(trunk={"spine": (50.0, 0.0, 0.0), "chest": (40.0, 0.0, 0.0)}),
    }


def impossible(rig: Rig) -> dict[str, Pose]:
    poses = {
        "leg behind the back": rig.posed(left_leg=((0.1, 0.3, -1.0), (0.1, 0.3, -1.0))),
        "legs split": rig.posed(legs=((1.0, 0.1, 0.0), (1.0, 0.1, 0.0))),
        "arm straight back": rig.posed(left_arm=((0.1, 0.2, -1.0), (0.1, 0.2, -1.0))),
        "shin along the thigh": rig.posed(left_leg=((0.0, -1.0, 0.0), (0.0, 1.0, -0.05))),
        "head turned round": rig.posed(trunk={"neck": (0, 80, 0), "head": (0, 80, 0)}),
        "trunk turned round": rig.posed(trunk={"spine": (0, 60, 0), "chest": (0, 60, 0)}),
        "folded backward": rig.posed(trunk={"spine": (-60, 0, 0), "chest": (-60, 0, 0)}),
        "ear through the shoulder": rig.posed(trunk={"neck": (0, 0, 70)}),
    }
    for name, part, axis, degrees in (
        ("knee bent forward", "left_shin", 0, -45.0),
        ("knee bent sideways", "left_shin", 1, 40.0),
        ("elbow bent backward", "left_forearm", 0, -60.0),
        ("hand turned round", "left_hand", 2, 150.0),
        ("foot turned back", "left_foot", 1, 90.0),
    ):
        pose = rig.model.standing_pose.copy()
        pose[rig.part(part)] += np.radians(degrees) * rig.prior.axes[rig.part(part), axis]
        poses[name] = pose
    return poses


def test_ordinary_poses_lie_within_the_limits(rig):
    beyond = {name: rig.excess(pose) for name, pose in possible(rig).items()}
    assert {name: degrees for name, degrees in beyond.items() if degrees >= ADMITTED} == {}


def test_the_pose_of_the_height_lies_within_them_but_for_straightened_elbows(rig):
    assert rig.excess(rig.model.standing_pose) < STRAIGHTENED


def test_what_no_joint_can_do_lies_beyond_them(rig):
    beyond = {name: rig.excess(pose) for name, pose in impossible(rig).items()}
    assert {name: degrees for name, degrees in beyond.items() if degrees <= REFUSED} == {}


@pytest.mark.parametrize("name", ["sitting", "arms crossed", "hands on hips"])
def test_bones_point_where_they_are_told(rig, name):
    turned = global_rotations(possible(rig)[name], rig.model.part_parent)
    expected = {
        "sitting": ("thigh", "shin", (0.1, -0.1, 1.0)),
        "arms crossed": ("forearm", "hand", (-1.0, 0.1, 0.45)),
        "hands on hips": ("forearm", "hand", (-0.8, -0.7, 0.5)),
    }[name]
    first, second = rig.part(f"left_{expected[0]}"), rig.part(f"left_{expected[1]}")
    bone = turned[first] @ unit(rig.joints[second] - rig.joints[first])
    np.testing.assert_allclose(bone, unit(np.array(expected[2])), atol=0.03)
