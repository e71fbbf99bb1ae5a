"""Poses that bodies are measured in, and those that the pose-dependent term learns from.

Stature is measured in the standing pose, girths in the canonical one. Both are relative to the rest
pose of the mesh, in which the arms hang out at about 40 degrees with bent elbows and the legs stand
apart.

Random poses lie within the limits of human joints. Their limbs aim at random directions within
reach rather than turn by random angles: raised arms, deep bends of hip, knee and elbow come up as
often as they matter in pictures.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from fitter.arrays import Pose
from fitter.numerics.rotations import rotation_matrices, rotation_vectors
from fitter.training.articulation.parts import PART_NAMES, PART_PARENT, part_index
from fitter.training.articulation.rig_drives import rest_axis

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


# Degrees, (lowest, highest) about body axes x (forward bend positive), y (turn to the left), z
# (lean to the right).
_TRUNK = {
    "spine": ((-15.0, 40.0), (-20.0, 20.0), (-20.0, 20.0)),
    "chest": ((-15.0, 30.0), (-25.0, 25.0), (-15.0, 15.0)),
    "neck": ((-25.0, 25.0), (-30.0, 30.0), (-20.0, 20.0)),
    "head": ((-25.0, 25.0), (-40.0, 40.0), (-20.0, 20.0)),
}
# Left side; degrees of elevation from straight down, of azimuth from straight out (forward
# positive), and of twist about the limb.
_ARM = ((0.0, 170.0), (-40.0, 120.0), (-60.0, 60.0))
_THIGH = ((0.0, 115.0), (0.0, 110.0), (-30.0, 30.0))
_ELBOW_BEND = (-40.0, 105.0)  # from the rest pose, whose elbow is bent by 40 degrees
_KNEE_BEND = (-5.0, 140.0)
_WRIST = ((-60.0, 70.0), (-30.0, 20.0), (-75.0, 75.0))  # to palm, to thumb, supination
_ANKLE = ((-25.0, 40.0), (-20.0, 20.0), (-15.0, 15.0))
_SLACK_DEGREES = 8.0
_CALM_SHARE = 0.35
"""Share of joints kept within a quarter of their range: pictures show more calm than bent ones."""

SIDES = {"left": np.array([1.0, 1.0, 1.0]), "right": np.array([1.0, -1.0, -1.0])}
"""Signs by which a left limb's turn becomes that of either side."""


def random_pose(rng: np.random.Generator) -> Pose:
    """One pose; the whole body's own turn stays zero, because nothing depends on it."""
    pose = np.zeros((len(PART_NAMES), 3))
    for part, limits in _TRUNK.items():
        pose[part_index(part)] = np.radians(_vector(rng, limits))
    for side, mirror in SIDES.items():
        for part, vector in _left_limbs(rng).items():
            pose[part_index(f"{side}_{part}")] = vector * mirror
    return pose


def _left_limbs(rng: np.random.Generator) -> dict[str, Float[np.ndarray, "3"]]:
    upper, lower = rest_axis("left_upper_arm"), rest_axis("left_forearm")
    hinge = np.cross(upper, lower)
    hinge /= np.linalg.norm(hinge)
    thigh = rest_axis("left_thigh")
    return {
        "upper_arm": _aim(rng, upper, *_ARM),
        "forearm": _bend(rng, hinge, _ELBOW_BEND),
        "hand": _wrist(rng, lower, hinge),  # the palm faces along the elbow's hinge
        "thigh": _aim(rng, thigh, *_THIGH),
        "shin": _bend(rng, np.array([1.0, 0.0, 0.0]), _KNEE_BEND),
        "foot": np.radians(_vector(rng, _ANKLE)),
    }


def aimed_limb(
    rng: np.random.Generator,
    axis: Float[np.ndarray, "3"],
    elevation: tuple[float, float],
    azimuth: tuple[float, float],
    twist: tuple[float, float],
) -> Float[np.ndarray, "3"]:
    """The turn that aims a left limb along a random direction, and twists it.

    Parameters
    ----------
    rng
        Draws the angles.
    axis
        Unit direction of the limb at rest.
    elevation, azimuth, twist
        Degrees, (lowest, highest): from straight down, from straight out (forward positive), and
        about the limb.
    """
    up, round_, turn = (np.radians(rng.uniform(*limits)) for limits in (elevation, azimuth, twist))
    target = np.array([np.sin(up) * np.cos(round_), -np.cos(up), np.sin(up) * np.sin(round_)])
    swing = rotation_between(axis, target)
    return rotation_vectors(swing[None] @ rotation_matrices((turn * axis)[None]))[0]


def _aim(
    rng: np.random.Generator,
    axis: Float[np.ndarray, "3"],
    elevation: tuple[float, float],
    azimuth: tuple[float, float],
    twist: tuple[float, float],
) -> Float[np.ndarray, "3"]:
    if rng.random() < _CALM_SHARE:
        return np.radians(rng.uniform(-15.0, 15.0, size=3))
    return aimed_limb(rng, axis, elevation, azimuth, twist)


def _bend(
    rng: np.random.Generator, hinge: Float[np.ndarray, "3"], limits: tuple[float, float]
) -> Float[np.ndarray, "3"]:
    angle = _range(rng, limits)
    return np.radians(angle * hinge + rng.uniform(-_SLACK_DEGREES, _SLACK_DEGREES, size=3))


def _wrist(
    rng: np.random.Generator, forearm: Float[np.ndarray, "3"], palm: Float[np.ndarray, "3"]
) -> Float[np.ndarray, "3"]:
    """A left hand's turn: a bend to the palm, one to the thumb, and supination."""
    flexion, deviation, twist = _vector(rng, _WRIST)
    return np.radians(flexion * np.cross(forearm, palm) + deviation * palm - twist * forearm)


def _vector(
    rng: np.random.Generator, limits: tuple[tuple[float, float], ...]
) -> Float[np.ndarray, "3"]:
    return np.array([_range(rng, pair) for pair in limits])


def _range(rng: np.random.Generator, limits: tuple[float, float]) -> float:
    share = 0.25 if rng.random() < _CALM_SHARE else 1.0
    return share * rng.uniform(*limits)


TWIST_DEGREES = (-45.0, 45.0)


@dataclass(frozen=True, slots=True, kw_only=True)
class ArmReach:
    """Directions of the upper arm in the trunk's frame, degrees, (lowest, highest).

    ``elevation`` is from straight down, ``azimuth`` from straight out, forward positive.
    """

    elevation: tuple[float, float]
    azimuth: tuple[float, float] = (-30.0, 100.0)


def with_arms_reaching(pose: Pose, reach: ArmReach, rng: np.random.Generator) -> Pose:
    """The pose with both upper arms along directions of their own, out of one class."""
    reaching = pose.copy()
    axis = rest_axis("left_upper_arm")
    for side, mirror in SIDES.items():
        turn = aimed_limb(rng, axis, reach.elevation, reach.azimuth, TWIST_DEGREES)
        reaching[part_index(f"{side}_upper_arm")] = turn * mirror
    return reaching


REACHES = (
    ArmReach(elevation=(100.0, 178.0)),
    ArmReach(elevation=(130.0, 178.0)),
    ArmReach(elevation=(50.0, 110.0), azimuth=(60.0, 130.0)),
)
"""Raised, overhead, before the chest."""

EVERY = 3
"""One pose in so many has arms that reach; the classes take turns."""


def taught_poses(rng: np.random.Generator) -> Iterator[Pose]:
    """Random poses without end, with arms often raised or crossed.

    A shoulder's skin depends on where the arm reaches in more ways than an elbow's on its bend, and
    random poses are few where it is hardest. With a third of the taught poses drawn there, women's
    shoulders are 3.5 mm off in place of 4.0 with arms overhead and 3.2 in place of 4.2 with arms
    crossed, and all else is as before.
    """
    while True:
        for reach in REACHES:
            yield with_arms_reaching(random_pose(rng), reach, rng)
            for _ in range(EVERY - 1):
                yield random_pose(rng)
