"""A stick person with the parts and landmarks of a real model, and plausible random poses."""

import numpy as np

from fitter.body.pose_prior import PosePrior, mean_pose, pose_prior
from fitter.numerics.rotations import compose
from fitter.pose_init.landmark_rig import LandmarkRig

PARENTS = {
    "pelvis": None,
    "spine": "pelvis",
    "chest": "spine",
    "neck": "chest",
    "head": "neck",
    "left_upper_arm": "chest",
    "left_forearm": "left_upper_arm",
    "left_hand": "left_forearm",
    "right_upper_arm": "chest",
    "right_forearm": "right_upper_arm",
    "right_hand": "right_forearm",
    "left_thigh": "pelvis",
    "left_shin": "left_thigh",
    "left_foot": "left_shin",
    "right_thigh": "pelvis",
    "right_shin": "right_thigh",
    "right_foot": "right_shin",
}
PART_NAMES = tuple(PARENTS)
PART_PARENT = np.array(
    [-1 if parent is None else PART_NAMES.index(parent) for parent in PARENTS.values()]
)

# Left side and middle, metres: joints, then landmarks with the part that carries them.
_JOINTS = {
    "pelvis": (0.0, 0.95, 0.0),
    "spine": (0.0, 1.06, -0.01),
    "chest": (0.0, 1.22, -0.02),
    "neck": (0.0, 1.50, -0.02),
    "head": (0.0, 1.60, 0.01),
    "left_upper_arm": (0.18, 1.43, -0.01),
    "left_forearm": (0.37, 1.22, -0.02),
    "left_hand": (0.53, 1.04, 0.03),
    "left_thigh": (0.09, 0.92, 0.01),
    "left_shin": (0.12, 0.50, 0.02),
    "left_foot": (0.14, 0.09, -0.02),
}
_LANDMARKS = {
    "nose": ("head", (0.0, 1.65, 0.12)),
    "chin": ("head", (0.0, 1.57, 0.10)),
    "head_top": ("head", (0.0, 1.80, 0.02)),
    "neck": ("chest", (0.0, 1.47, 0.04)),
    "left_eye": ("head", (0.033, 1.68, 0.10)),
    "left_ear": ("head", (0.075, 1.66, 0.01)),
    "left_shoulder": ("chest", (0.18, 1.44, -0.01)),
    "left_elbow": ("left_upper_arm", (0.37, 1.22, -0.02)),
    "left_wrist": ("left_forearm", (0.53, 1.04, 0.03)),
    "left_hip": ("pelvis", (0.09, 0.92, 0.02)),
    "left_knee": ("left_thigh", (0.12, 0.50, 0.03)),
    "left_ankle": ("left_shin", (0.14, 0.09, -0.02)),
    "left_toe": ("left_foot", (0.16, 0.01, 0.18)),
    "left_heel": ("left_foot", (0.14, 0.01, -0.07)),
}


def stick_figure() -> LandmarkRig:
    """The person at rest: arms half raised, left and right exact mirror images."""
    joints = np.array([_mirrored(name, _JOINTS) for name in PART_NAMES])
    landmarks = dict(_LANDMARKS)
    for name, (part, place) in _LANDMARKS.items():
        if name.startswith("left_"):
            right = name.replace("left_", "right_")
            landmarks[right] = (
                part.replace("left_", "right_"),
                (-place[0], place[1], place[2]),
            )
    names = tuple(landmarks)
    points = np.array([place for _, place in landmarks.values()])
    weights = np.zeros((len(names), len(PART_NAMES)))
    arms = np.zeros((*weights.shape, 3))
    for row, (part, place) in enumerate(landmarks.values()):
        column = PART_NAMES.index(part)
        weights[row, column] = 1.0
        arms[row, column] = np.array(place) - joints[column]
    return LandmarkRig(
        part_names=PART_NAMES,
        part_parent=PART_PARENT,
        rest_joints=joints,
        landmark_names=names,
        rest_landmarks=points,
        weights=weights,
        arms=arms,
    )


def _mirrored(name: str, table: dict) -> np.ndarray:
    if name.startswith("right_"):
        return np.array(table[name.replace("right_", "left_")]) * [-1.0, 1.0, 1.0]
    return np.array(table[name])


def stick_prior(rig: LandmarkRig) -> PosePrior:
    return pose_prior(rig.part_names, rig.part_parent, rig.rest_joints)


def plausible_pose(prior: PosePrior, rng: np.random.Generator, *, yaw: float) -> np.ndarray:
    """Joint angles drawn from the prior within the limits, the body turned by ``yaw`` (radians)."""
    spread = np.where(
        prior.precision > 0.0, 1.0 / np.where(prior.precision > 0, prior.precision, 1), 0
    )
    angles = prior.mean + spread * rng.standard_normal(prior.mean.shape)
    angles = np.clip(angles, prior.lower, prior.upper)
    pose = np.einsum("pai,pa->pi", prior.axes, angles)
    tilt = rng.normal(0.0, 0.12, 3) * [1.0, 0.0, 1.0]
    pose[0] = compose(np.array([[0.0, yaw, 0.0]]), tilt[None])[0]
    return pose


def mirrored_pose(pose: np.ndarray) -> np.ndarray:
    """The pose of the mirror image."""
    partners = [
        PART_NAMES.index(
            name.replace("left_", "right_")
            if name.startswith("left_")
            else name.replace("right_", "left_")
        )
        for name in PART_NAMES
    ]
    return pose[..., partners, :] * [1.0, -1.0, -1.0]


def upright_pose(prior: PosePrior) -> np.ndarray:
    return mean_pose(prior)
