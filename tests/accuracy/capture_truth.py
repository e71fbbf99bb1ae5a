"""Which findings of the checks of a capture are right, of a picture whose truth is known."""

from collections.abc import Mapping
from dataclasses import replace

import cv2
import numpy as np

from fitter.arrays import Mask
from fitter.capture.capture import Capture
from fitter.capture.framing import NEAREST_M
from fitter.capture.posture import free_share
from fitter.vocabulary.choices import ViewKind
from fitter.vocabulary.remarks import Code
from tests.accuracy.joint_figures import part_of_joint
from tests.accuracy.scene import Series
from tests.accuracy.true_picture import TruePicture

FRONTAL_DEG, TURNED_DEG, LATERAL_DEG = 40.0, 60.0, 75.0
"""Up to the first, people are seen from the front; from the second on they are not; from the third
on from the side."""

FREE, AGAINST = 0.4, 0.2
"""Share of an arm that background separates from the trunk, from which it is free and up to which
it lies against the trunk."""

DISTANCE_DOUBT = 0.06
"""How far from the least distance a true one is to be to say that the camera was too near."""


def variants_of(
    capture: Capture, picture: TruePicture
) -> list[tuple[str, Capture, Mapping[Code, bool]]]:
    """Names, questions about a picture as it is, and the truth of each code.

    Of a code that is left out nothing is known.
    """
    turned = turn_deg(picture)
    # Where nothing else is said people are seen whole, alone, sharp and upright in good light.
    plain = dict.fromkeys(Code, False) | {
        Code.CLOTHES_LOOSE: picture.series is Series.CLOTHED,
        Code.OTHER_VIEW: turned >= TURNED_DEG,
        Code.CAMERA_TOO_NEAR: _is_near(capture.focal_length_px, capture, picture),
        Code.ARMS_AGAINST_TRUNK: _lie_against(capture, picture.person_mask),
    }
    if FRONTAL_DEG < turned < TURNED_DEG:
        plain[Code.OTHER_VIEW] = None
    if turned > FRONTAL_DEG:
        plain[Code.ARMS_AGAINST_TRUNK] = None
    zoomed = None if capture.focal_length_px is None else 0.5 * capture.focal_length_px
    variants = [
        ("as it is, said from the front", replace(capture, view=ViewKind.FRONT), plain),
        (
            "said from the side",
            replace(capture, view=ViewKind.SIDE),
            {
                Code.OTHER_VIEW: False
                if turned >= LATERAL_DEG
                else None
                if turned >= TURNED_DEG
                else True
            },
        ),
        ("said from behind", replace(capture, view=ViewKind.BACK), {Code.OTHER_VIEW: True}),
        (
            "half the focal length",
            replace(capture, focal_length_px=zoomed),
            {Code.CAMERA_TOO_NEAR: _is_near(zoomed, capture, picture)},
        ),
    ]
    return [
        (name, asked, {code: wrong for code, wrong in truth.items() if wrong is not None})
        for name, asked, truth in variants
    ]


def turn_deg(picture: TruePicture) -> float:
    """How far the trunk is turned from the camera, degrees: the mean of shoulders and hips."""
    turns: list[float] = []
    for pair in ("shoulder", "hip"):
        left, right = (
            picture.joints[part_of_joint(f"{side}_{pair}")] for side in ("left", "right")
        )
        across = left - right
        turns.append(abs(float(np.degrees(np.arctan2(across[2], across[0])))))
    return float(np.mean(turns))


def _is_near(focal_length_px: float | None, capture: Capture, picture: TruePicture) -> bool | None:
    """Whether a camera of this lens stood too near; None if it is hard to say."""
    if focal_length_px is None:
        return None
    hips = picture.joints[[part_of_joint(f"{side}_hip") for side in ("left", "right")], 2]
    zoom = focal_length_px / (picture.focal_length_px * capture.scale)
    distance_m = float(np.mean(hips)) * zoom
    if abs(distance_m / NEAREST_M - 1.0) < DISTANCE_DOUBT:
        return None
    return distance_m < NEAREST_M


def _lie_against(capture: Capture, true_mask: Mask) -> bool | None:
    """Whether by the true outline an arm lies against the trunk; None if it is hard to say."""
    height, width = capture.picture.shape[:2]
    mask = cv2.resize(true_mask.astype(np.uint8), (width, height), interpolation=cv2.INTER_NEAREST)
    shares = [free_share(capture, mask > 0, side) for side in ("left", "right")]
    if None in shares:
        return None
    least = min(share for share in shares if share is not None)
    return None if AGAINST < least < FREE else least <= AGAINST
