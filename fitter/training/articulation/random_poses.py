"""Random poses within the limits of human joints, to train and test the pose-dependent term.

Limbs aim at random directions within reach rather than turn by random angles: raised arms, deep
bends of hip, knee and elbow come up as often as they matter in pictures.
"""

import numpy as np
from jaxtyping import Float

from fitter.arrays import Pose
from fitter.numerics.rotations import rotation_matrices, rotation_vectors
from fitter.training.articulation.named_poses import rotation_between
from fitter.training.articulation.part_tree import PART_NAMES, part_index
from fitter.training.articulation.rig_drives import rest_axis

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
"""What makes a left limb's turn that of either side."""


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
