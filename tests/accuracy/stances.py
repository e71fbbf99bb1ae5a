"""From the description of a stance to the pose of the 17 parts, for one person's joints."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
from jaxtyping import Float

from fitter.arrays import Pose, Vertices
from fitter.numerics.rotations import rotation_matrices, rotation_vectors
from fitter.training.articulation.parts import PART_NAMES, part_index
from fitter.training.articulation.poses import rotation_between
from tests.accuracy.scene import Arm, Leg, Stance

BISECTIONS = 16
DEEPEST_KNEE_DEGREES = 90.0

Rotation = Float[np.ndarray, "3 3"]
Direction = Float[np.ndarray, "3"]


def pose_of(stance: Stance, joints: Float[np.ndarray, "p 3"]) -> Pose:
    """The pose of a person with these joints at rest; the feet are not brought to the floor."""
    pose = np.zeros((len(PART_NAMES), 3))
    pelvis = _turn(*stance.pelvis)
    pose[0] = _vector(_turn(0.0, stance.facing, 0.0) @ pelvis)
    for part in ("spine", "chest", "neck", "head"):
        pose[part_index(part)] = _vector(_turn(*getattr(stance, part)))
    for side, arm, leg in (
        ("left", stance.left_arm, stance.left_leg),
        ("right", stance.right_arm, stance.right_leg),
    ):
        _set_arm(pose, joints, side, arm)
        _set_leg(pose, joints, side, leg, pelvis)
    return pose


def standing_on_both_feet(
    stance: Stance,
    joints: Float[np.ndarray, "p 3"],
    foot_height: Callable[[Pose, str], float],
) -> Pose:
    """The pose with the free leg's knee bent until its foot is as low as the other.

    ``foot_height`` gives the lowest point of the foot of a side, metres.
    """
    other = "right" if stance.free_leg == "left" else "left"

    def posed(bend: float) -> Pose:
        name = f"{stance.free_leg}_leg"
        leg: Leg = getattr(stance, name)
        return pose_of(replace(stance, **{name: replace(leg, bend=bend)}), joints)

    def too_low(pose: Pose) -> bool:
        return foot_height(pose, stance.free_leg) < foot_height(pose, other)

    low, high = 0.0, DEEPEST_KNEE_DEGREES
    if not too_low(posed(low)):
        return posed(low)
    for _ in range(BISECTIONS):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if too_low(posed(middle)) else (low, middle)
    return posed(high)


def lowest(vertices: Vertices, members: np.ndarray) -> float:
    """Height of the lowest of some vertices."""
    return float(vertices[members, 1].min())


def _set_arm(pose: Pose, joints: Float[np.ndarray, "p 3"], side: str, arm: Arm) -> None:
    shoulder, elbow, wrist = (
        joints[part_index(f"{side}_{name}")] for name in ("upper_arm", "forearm", "hand")
    )
    upper, lower = _unit(elbow - shoulder), _unit(wrist - elbow)
    outward = 1.0 if side == "left" else -1.0
    hinge = _unit(np.cross(upper, lower))
    bent_at_rest = np.degrees(np.arccos(np.clip(upper @ lower, -1.0, 1.0)))
    swing = rotation_between(upper, _aim(arm.raised, arm.forward, outward))
    twist = _about(upper, -outward * arm.turn)
    pose[part_index(f"{side}_upper_arm")] = _vector(swing @ twist)
    pose[part_index(f"{side}_forearm")] = np.radians(arm.bend - bent_at_rest) * hinge
    pose[part_index(f"{side}_hand")] = np.radians(-outward * arm.palm) * lower


def _set_leg(
    pose: Pose, joints: Float[np.ndarray, "p 3"], side: str, leg: Leg, pelvis: Rotation
) -> None:
    hip, knee, ankle = (joints[part_index(f"{side}_{name}")] for name in ("thigh", "shin", "foot"))
    outward = 1.0 if side == "left" else -1.0
    upper, lower = _unit(knee - hip), _unit(ankle - knee)
    upright = _turn(0.0, outward * leg.turn, 0.0)
    thigh = upright @ rotation_between(upper, upright.T @ _aim(leg.raised, leg.forward, outward))
    straight = rotation_between(lower, upper)
    shin = thigh @ _about(np.array([1.0, 0.0, 0.0]), leg.bend) @ straight
    foot = _turn(0.0, outward * leg.toe_out, 0.0) @ _turn(leg.heel_up, 0.0, 0.0)
    pose[part_index(f"{side}_thigh")] = _vector(pelvis.T @ thigh)
    pose[part_index(f"{side}_shin")] = _vector(thigh.T @ shin)
    pose[part_index(f"{side}_foot")] = _vector(shin.T @ foot)


def _aim(raised: float, forward: float, outward: float) -> Direction:
    up, ahead = np.radians(raised), np.radians(forward)
    return np.array([outward * np.sin(up) * np.cos(ahead), -np.cos(up), np.sin(up) * np.sin(ahead)])


def _turn(bend: float, turn: float, lean: float) -> Rotation:
    """Lean first, then bend forward, then turn to the left."""
    about_x, about_y, about_z = (
        _about(axis, angle) for axis, angle in zip(np.eye(3), (bend, turn, lean), strict=True)
    )
    return about_y @ about_x @ about_z


def _about(axis: Direction, degrees: float) -> Rotation:
    return rotation_matrices((np.radians(degrees) * axis)[None])[0]


def _unit(vector: Direction) -> Direction:
    return vector / np.linalg.norm(vector)


def _vector(rotation: Rotation) -> Direction:
    return rotation_vectors(rotation[None])[0]
