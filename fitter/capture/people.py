"""Whether one person is in the picture: neither nobody nor several."""

from typing import Final

import cv2
import numpy as np

from fitter.capture.capture import Capture
from fitter.capture.posture import detected_posture
from fitter.detection.body_landmarks import FACE_NEARBY
from fitter.detection.detector import DetectedBody
from fitter.detection.person_detector import DetectedFace
from fitter.vocabulary.remarks import Code, Remark, Severity, remark, unchecked

SURE: Final = 0.9
"""Probability from which, or 1 minus it, the detector is sure of a pixel."""

RIM_SHARE: Final = 0.012
"""Half the width of a mask's own rim, where no detector is sure, of the person's height."""

MUDDLED_SHARE: Final = 0.14
"""Two people are not told apart where the detector is unsure of as much, of the person's area. Of
62 pictures of one person it is at most 0.02, with a bag at 0.09; of 22 people before or behind
others 0.06 to 1.04, and from 0.23 on points go astray (tuning halves)."""

_SIDES: Final = ("left", "right")

NO_DETECTOR = "No detector looked at the picture."


def somebody(capture: Capture) -> Remark | None:
    """Whether the person who is meant was found."""
    if capture.bodies is None:
        return unchecked(Code.NOBODY_FOUND, NO_DETECTOR)
    if capture.body is not None:
        return None
    if not capture.bodies:
        reason = "Nobody was found in the picture who can be measured."
    else:
        reason = f"{len(capture.bodies)} people were found, but nobody where the points lie."
    # Whether the points show somebody whom the detector misses, the fit's verdict says.
    is_fitted = capture.directions is not None
    return remark(
        Code.NOBODY_FOUND, reason, severity=Severity.HARMS if is_fitted else Severity.BLOCKS
    )


def nobody_else(capture: Capture) -> Remark | None:
    """Whether others are in the picture, and nobody says who is meant or they overlap."""
    if capture.bodies is None:
        return unchecked(Code.SEVERAL_PEOPLE, NO_DETECTOR)
    if not capture.is_clicked and len(_faces(capture)) > 1:
        return remark(
            Code.SEVERAL_PEOPLE,
            f"{len(_faces(capture))} faces are seen where one person was found: what belongs "
            "to whom cannot be told.",
            severity=Severity.BLOCKS,
        )
    share = 0.0 if capture.is_clicked else _unsure_share(capture)
    if share > MUDDLED_SHARE:
        return remark(
            Code.SEVERAL_PEOPLE,
            f"It cannot be told what belongs to the person, of {share:.0%} of their size: "
            "somebody stands behind or before them.",
            severity=Severity.BLOCKS,
        )
    others = [each for each in capture.bodies if each is not capture.body]
    if capture.body is None or not others or capture.is_chosen:
        return None
    return remark(
        Code.SEVERAL_PEOPLE,
        f"{len(capture.bodies)} people were found; the largest is taken.",
        severity=Severity.HARMS,
    )


def _faces(capture: Capture) -> list[DetectedFace]:
    """Faces about the person's head but for those of others who were found."""
    if capture.body is None:
        return []
    noses = [
        np.array([nose.x, nose.y])
        for each in capture.bodies or ()
        if each is not capture.body and (nose := each.points.get("nose")) is not None
    ]
    near = FACE_NEARBY * capture.body.person.radius
    return [
        each
        for each in capture.body.faces
        if all(np.linalg.norm(each.middle - nose) > near for nose in noses)
    ]


def _unsure_share(capture: Capture) -> float:
    """Area in which the detector is unsure whether it sees the person, over the person's."""
    if capture.body is None or capture.mask is None or not capture.mask.any():
        return 0.0
    probability = capture.body.mask
    unsure = (probability > 1.0 - SURE) & (probability < SURE)
    tall = np.ptp(np.flatnonzero(capture.mask.any(axis=1)))
    depth = cv2.distanceTransform(unsure.astype(np.uint8), cv2.DIST_L2, cv2.DIST_MASK_5)
    return float(np.count_nonzero(depth > RIM_SHARE * tall) / np.count_nonzero(capture.mask))


def face(capture: Capture) -> Remark | None:
    """Whether the face of who is seen from the front is hidden."""
    if capture.body is None:
        return unchecked(Code.FACE_HIDDEN, NO_DETECTOR)
    if not capture.body.hides_face:
        return None
    return remark(
        Code.FACE_HIDDEN,
        "The person is seen from the front, but no face: something hides it. Which way they "
        "face is judged by trunk and legs, and their skin's colour by the hands alone.",
        severity=Severity.HARMS,
        where=("nose", "left_eye", "right_eye"),
    )


MOST_BETWEEN_EYES: Final = 0.055
"""Distance of the detector's eyes, as a share of the stature. It is 0.048 at most in 110 pictures
of grown-up people and 0.037 on average from the front (tuning half); children's eyes are a sixth
farther apart at ten years, a quarter at five and two thirds at one, by their stature. So small
children are found. The ears' distance would find more, and is too near to that of some adults."""


def proportions(capture: Capture) -> Remark | None:
    """Whether the eyes are too far apart for the stature of a grown-up person.

    Clicks are not looked at: they lie farther apart than the detector's eyes.
    """
    if capture.body is None:
        return unchecked(Code.CHILD, "Without a detector eyes are not compared.")
    eyes = [capture.joints.get(f"{side}_eye") for side in ("left", "right")]
    if eyes[0] is None or eyes[1] is None or capture.stature_px is None:
        return unchecked(Code.CHILD, "Both eyes are not seen.")
    # How tall somebody is who does not stand, or to the thighs alone, a picture hardly tells.
    if detected_posture(capture) is not None or not _sees_stature(capture.body):
        return unchecked(Code.CHILD, "The person is not seen to stand from head to foot.")
    share = float(np.linalg.norm(eyes[0] - eyes[1])) / capture.stature_px
    if share <= MOST_BETWEEN_EYES:
        return None
    return remark(
        Code.CHILD,
        f"The eyes are {100.0 * share:.1f} % of the stature apart, and those of grown-up "
        f"people at most {100.0 * MOST_BETWEEN_EYES:.1f}: this seems to be a child, and the "
        "bodies are those of grown-up people.",
        severity=Severity.BLOCKS,
        where=("left_eye", "right_eye"),
    )


def _sees_stature(body: DetectedBody) -> bool:
    """Whether eyes, shoulders, hips and an ankle are seen: others are guesses."""
    seen = {name for name, each in body.points.items() if not each.occluded}
    both = {f"{side}_{point}" for side in _SIDES for point in ("eye", "shoulder", "hip")}
    return seen >= both and any({f"{side}_knee", f"{side}_ankle"} <= seen for side in _SIDES)
