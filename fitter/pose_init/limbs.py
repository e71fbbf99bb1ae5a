"""Limbs: straight segments whose slant follows from their image length and true length.

Section 3.1: limb lengths are not asked for but predicted, as linear combinations of vertices of
the mean person of the given gender and height. A limb here runs between two clickable landmarks.
The trunk is one limb from the middle of the hips to the middle of the shoulders, with two
cross-pieces, the hip line and the shoulder line, whose slant is its rotation about the long axis.

A limb of length L at depth z, slanted by an angle a to the image plane, spans about f L cos(a) / z
pixels. So f L / (image length) = z / cos(a) is at least the depth: every limb gives an upper
bound, and the smallest bound is the tightest, reached when its limb is parallel. The paper says
that the chosen limb *minimises* the ratio between its image length and its actual length; that
limb would be the most foreshortened one and its bound the loosest. We assume that the opposite was
meant: the limb that **maximises image length / actual length**.

Taking a maximum over noisy ratios favours whichever limb has an error upwards, short limbs most.
Each ratio is therefore lowered by its own uncertainty before they are compared.
"""

from collections.abc import Collection, Container, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from fitter.arrays import Vector3
from fitter.detection.detector import DetectedSlants
from fitter.observation.clicks import DEFAULT_SPREAD_M
from fitter.pose_init.landmark_rig import LandmarkRig
from fitter.render.camera import Camera


@dataclass(frozen=True, slots=True, kw_only=True)
class Limb:
    """A limb from its proximal to its distal point, moved by ``part``.

    ``parent`` is the limb it is attached to, None for limbs at the trunk.
    """

    name: str
    proximal: str
    distal: str
    parent: str | None


TORSO = "torso"
PELVIS_MIDDLE = "pelvis_middle"
THORAX_MIDDLE = "thorax_middle"
HIPS = ("right_hip", "left_hip")
SHOULDERS = ("right_shoulder", "left_shoulder")
MIDDLES: Mapping[str, tuple[str, str]] = {PELVIS_MIDDLE: HIPS, THORAX_MIDDLE: SHOULDERS}

LIMBS: tuple[Limb, ...] = (
    Limb(name=TORSO, proximal=PELVIS_MIDDLE, distal=THORAX_MIDDLE, parent=None),
    *(
        limb
        for side in ("left", "right")
        for limb in (
            Limb(
                name=f"{side}_upper_arm",
                proximal=f"{side}_shoulder",
                distal=f"{side}_elbow",
                parent=None,
            ),
            Limb(
                name=f"{side}_forearm",
                proximal=f"{side}_elbow",
                distal=f"{side}_wrist",
                parent=f"{side}_upper_arm",
            ),
            Limb(
                name=f"{side}_thigh",
                proximal=f"{side}_hip",
                distal=f"{side}_knee",
                parent=None,
            ),
            Limb(
                name=f"{side}_shin",
                proximal=f"{side}_knee",
                distal=f"{side}_ankle",
                parent=f"{side}_thigh",
            ),
        )
    ),
)
LIMB_NAMES = tuple(limb.name for limb in LIMBS)
CHAINS = (
    ("left_upper_arm", "left_forearm"),
    ("right_upper_arm", "right_forearm"),
    ("left_thigh", "left_shin"),
    ("right_thigh", "right_shin"),
)
"""The four two-limb chains attached to the trunk."""


def limb_named(name: str) -> Limb:
    """The limb of this name."""
    return LIMBS[LIMB_NAMES.index(name)]


def point_at_rest(rig: LandmarkRig, name: str) -> Float[np.ndarray, "3"]:
    """A limb's end at rest: a landmark, or the middle of two."""
    return end_row(name, rig.landmark_names) @ rig.rest_landmarks


def limb_direction_at_rest(rig: LandmarkRig, limb: Limb) -> Float[np.ndarray, "3"]:
    """From the proximal to the distal point, body frame, metres."""
    return point_at_rest(rig, limb.distal) - point_at_rest(rig, limb.proximal)


def limb_lengths_m(rig: LandmarkRig) -> dict[str, float]:
    """Length of every limb, and of ``hips`` and ``shoulders`` across, metres."""
    lengths = {
        limb.name: float(np.linalg.norm(limb_direction_at_rest(rig, limb))) for limb in LIMBS
    }
    for name, (right, left) in (("hips", HIPS), ("shoulders", SHOULDERS)):
        lengths[name] = float(np.linalg.norm(rig.landmark(left) - rig.landmark(right)))
    return lengths


def end_row(point: str, names: tuple[str, ...]) -> Float[np.ndarray, " k"]:
    """A limb's end as a combination of landmarks in this order."""
    corners = landmarks_of(point)
    return np.array([1.0 / len(corners) if name in corners else 0.0 for name in names])


def limb_slant(limb: Limb, names: tuple[str, ...]) -> Float[np.ndarray, " k"]:
    """Far end minus near end as a combination of landmarks in this order."""
    return end_row(limb.distal, names) - end_row(limb.proximal, names)


def landmarks_of(point: str) -> tuple[str, ...]:
    """The landmarks a limb's end is made of."""
    return MIDDLES.get(point, (point,))


LIMB_LENGTH_SPREAD = 0.04
"""Relative standard deviation of a limb's length among people of one gender and height."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ReferenceLimb:
    """The chosen limb and its image length over its actual length, pixels per metre."""

    limb: Limb
    scale: float


def reference_limb(
    ends: Mapping[str, Float[np.ndarray, "2"]],
    lengths_m: Mapping[str, float],
    *,
    candidates: Sequence[str],
) -> ReferenceLimb:
    """Pick the limb most parallel to the image plane.

    Parameters
    ----------
    ends
        Pixels of limb ends by point name.
    lengths_m
        Limb lengths by limb name.
    candidates
        Names of limbs with both ends seen; at least one.
    """
    best: ReferenceLimb | None = None
    best_bound = -np.inf
    for limb in LIMBS:
        if limb.name not in candidates:
            continue
        length = lengths_m[limb.name]
        scale = float(np.linalg.norm(ends[limb.distal] - ends[limb.proximal])) / length
        spread = np.hypot(LIMB_LENGTH_SPREAD, np.sqrt(2.0) * DEFAULT_SPREAD_M / length)
        bound = scale * (1.0 - spread)
        if bound > best_bound:
            best, best_bound = ReferenceLimb(limb=limb, scale=scale), bound
    if best is None:
        message = "reference_limb needs at least one candidate"
        raise ValueError(message)
    return best


TRUNCATION = 1.5
"""Standard deviations beyond which a slant is trusted less and less: one in twenty is wrong."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class LimbReaches:
    """Distances along the view from the near ends of limbs to the far ones.

    Attributes
    ----------
    limbs
        s limbs, both of whose ends are known points.
    toward
        (3,) unit vector from the camera to the person, camera frame.
    reach_m, sigma_m
        (s,) how much farther, and its standard deviation, metres.
    """

    limbs: tuple[Limb, ...]
    toward: Vector3
    reach_m: Float[np.ndarray, " s"]
    sigma_m: Float[np.ndarray, " s"]


def limb_reaches(
    slants: DetectedSlants,
    rig: LandmarkRig,
    camera: Camera,
    *,
    points: Collection[str],
    without: Container[str] = (),
) -> LimbReaches:
    """Reaches of the limbs of a rig whose two ends are among ``points``, but for some by name."""
    limbs = tuple(
        limb
        for limb in map(limb_named, slants.limbs)
        if limb.name not in without and limb.proximal in points and limb.distal in points
    )
    lengths = limb_lengths_m(rig)
    told = [(slants.limbs[limb.name], lengths[limb.name]) for limb in limbs]
    ray = camera.rays(slants.middle)
    return LimbReaches(
        limbs=limbs,
        toward=ray / np.linalg.norm(ray),
        reach_m=np.array([length * slant.sine for slant, length in told]),
        sigma_m=np.array([length * slant.sigma for slant, length in told]),
    )
