"""The standing pose that stature is measured in, and the canonical pose girths are measured in.

Both are relative to the rest pose of the mesh, in which the arms hang out at about 40 degrees with
bent elbows and the legs stand apart.
"""

import numpy as np
from jaxtyping import Float

from fitter.arrays import Pose
from fitter.numerics.rotations import rotation_matrices, rotation_vectors
from fitter.training.articulation.part_tree import PART_NAMES, PART_PARENT, part_index

STANDING_ARM_DEGREES = 12.0
STANDING_LEG_DEGREES = 2.0
CANONICAL_ARM_DEGREES = 40.0
CANONICAL_LEG_DEGREES = 7.0
"""Angles between a limb and straight down, outward in the frontal plane. In the canonical pose the
arms stay clear of a large trunk and the thighs of each other; a chest girth taken with the arms
there is about what a tape finds on a person with the arms slightly lifted."""


def standing_pose(joints: Float[np.ndarray, "p 3"]) -> Pose:
    """Upright, legs straight and vertical, arms beside the body, feet and hands in line."""
    return _straight_limbs(joints, STANDING_ARM_DEGREES, STANDING_LEG_DEGREES)


def canonical_pose(joints: Float[np.ndarray, "p 3"]) -> Pose:
    """Arms away from the trunk and straight, legs straight and slightly apart."""
    return _straight_limbs(joints, CANONICAL_ARM_DEGREES, CANONICAL_LEG_DEGREES)


def _straight_limbs(
    joints: Float[np.ndarray, "p 3"], arm_degrees: float, leg_degrees: float
) -> Pose:
    turned = np.broadcast_to(np.eye(3), (len(PART_NAMES), 3, 3)).copy()
    for side, outward in (("left", 1.0), ("right", -1.0)):
        arm = _down_and_out(arm_degrees, outward)
        leg = _down_and_out(leg_degrees, outward)
        limbs = ((("upper_arm", "forearm", "hand"), arm), (("thigh", "shin", "foot"), leg))
        for names, direction in limbs:
            first, second, third = (part_index(f"{side}_{name}") for name in names)
            turned[first] = rotation_between(joints[second] - joints[first], direction)
            turned[second] = rotation_between(joints[third] - joints[second], direction)
            # The hand goes on with the forearm; the foot keeps its sole on the ground.
            turned[third] = turned[second] if names[2] == "hand" else np.eye(3)
    return relative_pose(turned)


def relative_pose(turned: Float[np.ndarray, "p 3 3"]) -> Pose:
    """Rotation vectors of parts relative to their parents, from rotations in the body frame."""
    parents = PART_PARENT
    base = np.where((parents < 0)[:, None, None], np.eye(3), turned[parents])
    return rotation_vectors(np.matmul(base.transpose(0, 2, 1), turned))


def rotation_between(
    start: Float[np.ndarray, "3"], end: Float[np.ndarray, "3"]
) -> Float[np.ndarray, "3 3"]:
    """The shortest rotation that takes one direction to another."""
    start, end = start / np.linalg.norm(start), end / np.linalg.norm(end)
    axis = np.cross(start, end)
    sine = float(np.linalg.norm(axis))
    if sine == 0.0:
        return np.eye(3)
    angle = np.arctan2(sine, float(start @ end))
    return rotation_matrices((axis / sine * angle)[None])[0]


def _down_and_out(degrees: float, outward: float) -> Float[np.ndarray, "3"]:
    return np.array([outward * np.sin(np.radians(degrees)), -np.cos(np.radians(degrees)), 0.0])
