"""Poses at the ends of the ranges of motion, in which articulation fails first.

Each turns the left limb or the trunk and leaves the rest in the canonical pose. Angles are
anatomical, so they hold for any body: where a limb points is given, not how far it turns from a
mesh's rest pose.
"""

from collections.abc import Mapping

import numpy as np
from jaxtyping import Float

from fitter.arrays import Pose
from fitter.body.skeleton import global_rotations
from fitter.numerics.rotations import rotation_matrices
from fitter.training.articulation.named_poses import (
    CANONICAL_ARM_DEGREES,
    canonical_pose,
    relative_pose,
    rotation_between,
)
from fitter.training.articulation.part_tree import PART_PARENT, part_index

Direction = Float[np.ndarray, "3"]
Joints = Float[np.ndarray, "p 3"]

SHOULDER_RAISED_DEGREES = 170.0
HIP_FLEXED_DEGREES = 115.0
HIP_ABDUCTED_DEGREES = 60.0
KNEE_BENT_DEGREES = 140.0
ELBOW_BENT_DEGREES = 145.0
SPINE_BENT_DEGREES = (40.0, 30.0)
SPINE_ARCHED_DEGREES = (-15.0, -15.0)
SPINE_LEANING_DEGREES = (20.0, 15.0)
SPINE_TWISTED_DEGREES = (20.0, 25.0)
"""Of the spine and of the chest, relative to the part below."""


def extreme_poses(joints: Joints) -> Mapping[str, Pose]:
    """Extreme poses by name, for a body with these joints at rest."""
    canonical = canonical_pose(joints)
    arm, leg = ("upper_arm", "forearm", "hand"), ("thigh", "shin", "foot")
    elbow = np.cross(*_bones(joints, arm))
    knee = np.array([1.0, 0.0, 0.0])

    def arms(upper: Direction, bend_degrees: float) -> Pose:
        return _with_limb(canonical, joints, arm, upper, elbow, bend_degrees)

    def legs(upper: Direction, bend_degrees: float) -> Pose:
        return _with_limb(canonical, joints, leg, upper, knee, bend_degrees)

    return {
        "shoulder raised": arms(_aim(SHOULDER_RAISED_DEGREES, 0.0), 0.0),
        "shoulder crossed in front": arms(_aim(80.0, 125.0), 30.0),
        "shoulder behind": arms(_aim(50.0, -80.0), 0.0),
        "elbow bent": arms(_aim(CANONICAL_ARM_DEGREES, 0.0), ELBOW_BENT_DEGREES),
        "hip flexed": legs(_aim(HIP_FLEXED_DEGREES, 90.0), 90.0),
        "hip abducted": legs(_aim(HIP_ABDUCTED_DEGREES, 0.0), 0.0),
        "knee bent": legs(_aim(0.0, 0.0), KNEE_BENT_DEGREES),
        "spine bent": _with_trunk(canonical, SPINE_BENT_DEGREES, axis=0),
        "spine arched": _with_trunk(canonical, SPINE_ARCHED_DEGREES, axis=0),
        "spine leaning": _with_trunk(canonical, SPINE_LEANING_DEGREES, axis=2),
        "spine twisted": _with_trunk(canonical, SPINE_TWISTED_DEGREES, axis=1),
    }


def _with_limb(
    pose: Pose,
    joints: Joints,
    names: tuple[str, str, str],
    upper: Direction,
    hinge: Direction,
    bend_degrees: float,
) -> Pose:
    """The left limb of three parts along a direction, bent about its hinge (at rest)."""
    first, second, third = (part_index(f"left_{name}") for name in names)
    upper_bone, lower_bone = _bones(joints, names)
    turned = global_rotations(pose, PART_PARENT)
    turned[first] = rotation_between(upper_bone, upper)
    bend = np.radians(bend_degrees) * hinge / np.linalg.norm(hinge)
    bent = turned[first] @ rotation_matrices(bend[None])[0]
    turned[second] = bent @ rotation_between(lower_bone, upper_bone)
    turned[third] = turned[second]
    return relative_pose(turned)


def _bones(joints: Joints, names: tuple[str, str, str]) -> tuple[Direction, Direction]:
    first, second, third = (joints[part_index(f"left_{name}")] for name in names)
    return second - first, third - second


def _with_trunk(pose: Pose, degrees: tuple[float, float], *, axis: int) -> Pose:
    bent = pose.copy()
    for name, angle in zip(("spine", "chest"), degrees, strict=True):
        bent[part_index(name), axis] = np.radians(angle)
    return bent


def _aim(raised: float, forward: float) -> Direction:
    """Degrees from straight down, and round from straight out to the left toward the front."""
    up, ahead = np.radians(raised), np.radians(forward)
    return np.array([np.sin(up) * np.cos(ahead), -np.cos(up), np.sin(up) * np.sin(ahead)])
