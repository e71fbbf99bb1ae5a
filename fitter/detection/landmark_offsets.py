"""How far the network's landmarks lie from ours, and the pixels at which ours are.

A landmark is where annotators put it: BlazePose's shoulders lie on top of the joint, its hips
toward the front of the body, its ankles, heels and toes inside the foot. In a picture the same
offset looks different from the front and from the side, and points of one person disagree about
their distance. So offsets are vectors in the frame of the trunk, which the network's landmarks in
space give within 12 degrees.
"""

from collections.abc import Mapping
from typing import Final

import numpy as np
from jaxtyping import Float

from fitter.arrays import Points2D
from fitter.detection.body_landmarks import BodyLandmarks
from fitter.detection.landmark_meanings import HIPS, INDEX_OF_POINT, SHOULDERS

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
"""How much higher they lie where the trunk is seen from the side: metres, by the square of the sine
of its turn, learned likewise.

What is not taken off: from the side the network draws near and far points at nearly one level, as
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
    """Of the picture where the person is, by the size of trunk and legs."""
    pixels, metres = landmarks.pixels[_SCALED_BY], landmarks.world_m[_SCALED_BY, :2]
    return float(
        np.linalg.norm(pixels - pixels.mean(axis=0)) / np.linalg.norm(metres - metres.mean(axis=0))
    )
