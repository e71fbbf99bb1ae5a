"""Names of the network's landmarks, and how far each can be trusted.

Landmarks are where the annotators put them; what all bodies share of that is taken off first
(:mod:`fitter.detection.landmark_meanings`). Spreads and slants were learned from 40 pictures of the
evaluation's tuning half and 16 of bodies by another maker, before anything was taken off: narrower
spreads gained nothing.

A landmark is where annotators put it: BlazePose's shoulders lie on top of the joint, its hips
toward the front of the body, its ankles, heels and toes inside the foot. In a picture the same
offset looks different from the front and from the side, and points of one person disagree about
their distance. So offsets are vectors in the frame of the trunk, which the network's landmarks in
space give within 12 degrees.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

import numpy as np
from jaxtyping import Float

from fitter.arrays import Points2D
from fitter.detection.body_landmarks import BodyLandmarks

_SIDED: Final[Mapping[str, int]] = {
    "shoulder": 11, "elbow": 13, "wrist": 15, "hip": 23, "knee": 25, "ankle": 27, "heel": 29,
    "toe": 31,
}  # fmt: skip

INDEX_OF_POINT: Final[Mapping[str, int]] = {
    "nose": 0, "left_eye": 2, "right_eye": 5, "left_ear": 7, "right_ear": 8,
    **{f"{side}_{name}": index + (side == "right")
       for name, index in _SIDED.items() for side in ("left", "right")},
}  # fmt: skip
"""Index among the network's 33 landmarks, by our name."""

_SPREADS_M: Final[Mapping[str, float]] = {
    "nose": 0.012, "eye": 0.012, "ear": 0.028, "shoulder": 0.022, "elbow": 0.022, "wrist": 0.018,
    "hip": 0.03, "knee": 0.018, "ankle": 0.018, "heel": 0.03, "toe": 0.03,
}  # fmt: skip
"""Root mean square error in each direction of the picture, metres on the body. There is no ground
truth for heels and toes."""

SEEN: Final = 0.5
"""Visibility at which a landmark counts as seen. Most of those below it are guesses."""

SPREAD_EXPONENT: Final = 0.6
"""Spreads grow as the confidence to minus this power. Of 1,632 landmarks in 136 pictures of the
evaluation's people, errors over the spreads above are 0.8 to 0.9 (root mean square) where the
confidence is 0.99, and 1.0, 1.4, 1.7, 2.9, 3.8 where it is 0.95, 0.6, 0.4, 0.18 and 0.07; the law
says 1.0, 1.4, 1.7, 2.8 and 4.9. By likelihood the power is 0.65 on either half, within 0.05."""

LEAST_CONFIDENCE: Final = 0.05
"""Below it nothing was measured: six times the spread, as far as a limb is long."""

UNSEEN_CONFIDENCE: Final = 0.16
"""Confidence of a guess for which none is told: three times the spread."""


def spread_m(point: str, confidence: float) -> float:
    """Standard deviation of a detector's point in each direction of the picture.

    Metres on the body; ``confidence`` is in [0, 1]. Other detectors are taken to err as ours does.
    """
    spread = _SPREADS_M[point.removeprefix("left_").removeprefix("right_")]
    return spread * max(confidence, LEAST_CONFIDENCE) ** -SPREAD_EXPONENT


@dataclass(frozen=True, slots=True, kw_only=True)
class SlantCalibration:
    """Predicts the sine of a limb's true slant from that of the network's landmarks in space.

    ``gain * sine + offset`` with standard deviation ``sigma``, which is 1.4 times that of the
    errors, because the errors of one person's limbs are correlated.
    """

    gain: float
    offset: float
    sigma: float


SLANTS: Final[Mapping[str, SlantCalibration]] = {
    "upper_arm": SlantCalibration(gain=1.0, offset=-0.06, sigma=0.29),
    "thigh": SlantCalibration(gain=1.07, offset=0.05, sigma=0.13),
    "shin": SlantCalibration(gain=0.69, offset=-0.10, sigma=0.17),
}
"""Forearms are left out: errors of 0.29, where the truth itself spreads by 0.35, add nothing to the
clicks."""

LIMB_ENDS: Final[Mapping[str, tuple[str, str]]] = {
    "upper_arm": ("shoulder", "elbow"),
    "thigh": ("hip", "knee"),
    "shin": ("knee", "ankle"),
}

SHOULDERS: Final = ("left_shoulder", "right_shoulder")
HIPS: Final = ("left_hip", "right_hip")


OFFSETS_M: Final[Mapping[str, tuple[float, float, float]]] = {
    "ear": (-0.017, 0.020, 0.021),
    "shoulder": (-0.008, 0.020, 0.001),
    "knee": (0.002, -0.003, 0.011),
    "hip": (-0.006, 0.010, 0.036),
    "ankle": (0.002, 0.016, 0.008),
    "heel": (0.002, -0.001, 0.023),
    "toe": (0.009, 0.008, -0.020),
}  # fmt: skip
"""The network's minus our landmarks on the true bodies of 60 pictures of the tuning half and, by
our body on the mesh, of 8 by another maker: outward, up, forward in the frame of the trunk, metres
on a person of average size. Both makers agree within 1.5 cm. Those of eyes, nose, elbows and
wrists are below 0.7 cm or differ by maker, so they are taken as they are."""

RAISED_IN_PROFILE_M: Final[Mapping[str, float]] = {"shoulder": 0.029, "knee": 0.018}
"""Further rise of landmarks where the trunk is seen from the side: metres, by the square of the
sine of its turn, learned likewise.

One error is left: from the side the network draws near and far points at nearly one level, as
if seen from afar. The far knee is 4 cm too low beside the near one by both makers' bodies, the far
ankle 3 to 5. Putting them apart, or trusting the far side less, brings no weight nearer to the
truth (DECISIONS.md, "What a fit takes from the detector").
"""

_SCALED_BY: Final = [
    INDEX_OF_POINT[f"{side}_{name}"]
    for side in ("left", "right")
    for name in ("shoulder", "hip", "knee", "ankle")
]


def own_pixels(landmarks: BodyLandmarks) -> Points2D:
    """(33, 2) pixels of the picture at which our landmarks of the same names are."""
    pixels = landmarks.pixels.copy()
    trunk = _trunk_frame(landmarks.world_m)
    scale = _pixels_per_metre(landmarks)
    profile = float(trunk[0, 2] ** 2)
    for name, index in INDEX_OF_POINT.items():
        landmark = name.split("_")[-1]
        outward, up, forward = OFFSETS_M.get(landmark, (0.0, 0.0, 0.0))
        aside = -outward if name.startswith("right_") else outward
        up += profile * RAISED_IN_PROFILE_M.get(landmark, 0.0)
        pixels[index] -= scale * (np.array([aside, up, forward]) @ trunk)[:2]
    return pixels


def _trunk_frame(world_m: Float[np.ndarray, "33 3"]) -> Float[np.ndarray, "3 3"]:
    """Rows left, up and forward of the trunk, in camera axes."""
    left_shoulder, right_shoulder, left_hip, right_hip = (
        world_m[INDEX_OF_POINT[name]] for name in (*SHOULDERS, *HIPS)
    )
    up = left_shoulder + right_shoulder - left_hip - right_hip
    up = up / np.linalg.norm(up)
    left = left_shoulder + left_hip - right_shoulder - right_hip
    left = left - (left @ up) * up
    left = left / np.linalg.norm(left)
    return np.stack([left, up, np.cross(left, up)])


def _pixels_per_metre(landmarks: BodyLandmarks) -> float:
    """Pixels per metre where the person is, by the size of trunk and legs."""
    pixels, metres = landmarks.pixels[_SCALED_BY], landmarks.world_m[_SCALED_BY, :2]
    return float(
        np.linalg.norm(pixels - pixels.mean(axis=0)) / np.linalg.norm(metres - metres.mean(axis=0))
    )
