"""Whether the person stands: who sits, crouches, lies or bends over is not measured well.

A trunk's shoulders and hips are as broad in the picture as the cosine of how far it is turned;
left and right are the person's own, so that the breadth of a trunk seen from behind is negative.
Faces do not tell: the detector calls eyes visible from behind too.
"""

import math
from typing import Final

import numpy as np
from jaxtyping import Bool, Float

from fitter.arrays import Mask
from fitter.capture.capture import Capture, Directions, Joints
from fitter.detection.body_landmarks import CLEARLY_TURNED, trunk_facing
from fitter.detection.detector import DetectedBody
from fitter.vocabulary.choices import ViewKind
from fitter.vocabulary.outcomes import SeenFrom
from fitter.vocabulary.remarks import Code, Remark, Severity, remark, unchecked

BENT_DEG, FOLDED_DEG = 35.0, 50.0
"""Both thighs turned from the trunk by more than the first make girths of waist and hips doubtful;
from the second on nobody stands. It is 20 degrees at most of 105 people who stand or stride, 29 of
a weightlifter."""

LEAST_LIMBS: Final = {"thigh": 0.61, "shin": 0.57}
"""Lengths in the picture, of the trunk's: the least of 113 people who stand or stride. A limb that
looks shorter points toward the camera or away from it, more than the detector's slants dare say."""

LEAST_TRUNK: Final = 1.05
"""The trunk's own, of the longer thigh's; 1.08 was the least."""

LYING_DEG = 55.0
"""Least angle between the trunk of a lying person and the vertical."""

KNEELING_DEG = 60.0
"""Knees that are both bent so far; 24 degrees at most of who stands."""

CROUCHED_DEG, SEATED_DEG = 40.0, 55.0
"""The straighter hip and the straighter knee together: of who sits toward the camera either may
look less bent than its own bound. It is 31 degrees at most in 88 pictures of people who stand or
stride, 56 at least of twelve who sit; two of these were measured 24 and 10 kg too heavy (tuning
halves). A weightlifter whose ankles are hidden by the bar he has dropped stands at 53."""

STOOPED_DEG = 36.0
LOW_HEAD, HANGING_HEAD = 0.05, 0.02
"""Least lean of the trunk of people who bend over, in space, as the detector sees it; and heights
of their noses over the shoulders, by the stature: up to the first this harms, up to the second it
blocks. Of 170 pictures of people who stand or stride, from all sides, trunks lean by 33 degrees at
most and noses are at 0.098 at least; where chests lean by 45 degrees trunks are seen to lean by 37
at least and noses are at 0.055 at most (tuning half). Neither tells alone: raised arms lift the
shoulders, and a high camera tilts the trunk."""


def posture(capture: Capture) -> Remark | None:
    """Whether trunk and thighs are in one line and upright, and the head is above the shoulders.

    Of a fit both the body and the detector are asked: bodies would rather stand.
    """
    found = detected_posture(capture)
    if capture.directions is not None:
        fitted = _posture(capture.directions)
        return max(fitted, found if found is not None and found.is_finding else None, key=_gravity)
    return found


def detected_posture(capture: Capture) -> Remark | None:
    """Remark on the posture by the detector alone, the same before a fit and after it."""
    return max(_posture(detected_directions(capture)), _head(capture), key=_gravity)


def _head(capture: Capture) -> Remark | None:
    """Height of the head: of who bends over it sinks between the shoulders, from any side."""
    nose, shoulders = capture.joints.get("nose"), capture.middle("shoulder")
    if capture.body is None or capture.body.leaning_deg < STOOPED_DEG:
        return None
    if nose is None or shoulders is None or capture.stature_px is None:
        return None
    height = float(shoulders[1] - nose[1]) / capture.stature_px
    if height > LOW_HEAD:
        return None
    return remark(
        Code.NOT_STANDING,
        f"The person bends over: the trunk leans by about {capture.body.leaning_deg:.0f} "
        f"degrees, and the nose is {100.0 * abs(height):.0f} % of the stature "
        f"{'above' if height > 0.0 else 'below'} the shoulders.",
        severity=Severity.HARMS if height > HANGING_HEAD else Severity.BLOCKS,
        where=("nose", "left_shoulder", "right_shoulder"),
    )


def _gravity(found: Remark | None) -> int:
    if found is None:
        return 0
    return len(Severity) - list(Severity).index(found.severity)


def _posture(directions: Directions) -> Remark | None:
    trunk = directions.get("trunk")
    hips = [
        angle_deg(-trunk, directions[name])
        for name in ("left_thigh", "right_thigh")
        if trunk is not None and name in directions
    ]
    # From the side the near leg alone is seen.
    if trunk is None or not hips:
        return unchecked(Code.NOT_STANDING, "Trunk and thighs are not both seen.")
    bent, knees = min(hips), _knees_deg(directions)
    folded = bent + knees
    leaning = angle_deg(np.array([0.0, -1.0, 0.0]), trunk)
    lies = leaning > LYING_DEG and bent < FOLDED_DEG
    kneels = knees >= KNEELING_DEG
    if bent < BENT_DEG and folded < CROUCHED_DEG and not lies and not kneels:
        return None
    sits = bent >= FOLDED_DEG or folded >= SEATED_DEG
    return remark(
        Code.NOT_STANDING,
        f"The person {_words(bent, knees, lies=lies, leaning=leaning)}: the thighs are "
        f"turned from the trunk by {bent:.0f} degrees, the shins from them by {knees:.0f}, "
        f"and the trunk from the vertical by {leaning:.0f}.",
        severity=Severity.BLOCKS if lies or kneels or sits else Severity.HARMS,
        where=("left_hip", "right_hip", "left_knee", "right_knee"),
    )


def detected_directions(capture: Capture) -> Directions:
    """By the detector's points and slants, and by how short trunk and limbs look.

    A trunk that does is taken to be bent toward the camera.
    """
    shoulders, hips = capture.middle("shoulder"), capture.middle("hip")
    limbs = {} if capture.body is None else _limbs(capture.joints, capture.body)
    if shoulders is None or hips is None or (shoulders == hips).all():
        return {name: _direction(limb, slant) for name, (limb, slant) in limbs.items()}
    trunk = float(np.linalg.norm(shoulders - hips))
    found = {
        name: _direction(
            limb,
            float(np.copysign(max(abs(slant), _foreshortening(limb, _least(name) * trunk)), slant)),
        )
        for name, (limb, slant) in limbs.items()
    }
    thighs = [float(np.linalg.norm(limb)) for name, (limb, _) in limbs.items() if "thigh" in name]
    least = LEAST_TRUNK * max(thighs, default=0.0)
    found["trunk"] = _direction(shoulders - hips, -_foreshortening(shoulders - hips, least))
    return found


def _limbs(joints: Joints, body: DetectedBody) -> dict[str, tuple[Float[np.ndarray, "2"], float]]:
    """Thighs and shins in the picture, pixels, and the sines of their slants."""
    found: dict[str, tuple[Float[np.ndarray, 2], float]] = {}
    for side in ("left", "right"):
        for limb, near, far in (("thigh", "hip", "knee"), ("shin", "knee", "ankle")):
            slant = body.slants.limbs.get(f"{side}_{limb}")
            ends = [joints.get(f"{side}_{end}") for end in (near, far)]
            if slant is not None and ends[0] is not None and ends[1] is not None:
                found[f"{side}_{limb}"] = (ends[1] - ends[0], slant.sine)
    return found


def _least(limb: str) -> float:
    return LEAST_LIMBS[limb.rpartition("_")[2]]


def _foreshortening(in_picture: Float[np.ndarray, "2"], least: float) -> float:
    """Sine of the least angle to the picture at which something looks so short."""
    share = float(np.linalg.norm(in_picture)) / max(least, 1e-9)
    return float(np.sqrt(max(1.0 - share**2, 0.0)))


def angle_deg(one: Float[np.ndarray, "3"], other: Float[np.ndarray, "3"]) -> float:
    """Between two unit vectors."""
    return float(np.degrees(np.arccos(np.clip(one @ other, -1.0, 1.0))))


def _direction(in_picture: Float[np.ndarray, "2"], sine: float) -> Float[np.ndarray, "3"]:
    across = np.sqrt(max(1.0 - sine**2, 0.0)) / max(float(np.linalg.norm(in_picture)), 1e-9)
    return np.array([across * in_picture[0], across * in_picture[1], sine])


def _knees_deg(directions: Directions) -> float:
    """Bend of the straighter knee; 0 where a thigh or a shin is not seen."""
    return min(
        angle_deg(directions[f"{side}_thigh"], directions[f"{side}_shin"])
        if {f"{side}_thigh", f"{side}_shin"} <= directions.keys()
        else 0.0
        for side in ("left", "right")
    )


def _words(bent: float, knees: float, *, lies: bool, leaning: float) -> str:
    if lies:
        return "lies"
    if bent < BENT_DEG and knees >= KNEELING_DEG:
        return "kneels"
    if knees >= BENT_DEG or bent < BENT_DEG:
        return "sits or crouches"
    return "bends over" if leaning > BENT_DEG else "sits or bends the hips"


LEAST_FRONTAL = 0.65
"""Cosine from which a person faces the camera or turns their back to it: within 50 degrees."""

_SAID = {
    ViewKind.FRONT: "from the front",
    ViewKind.SIDE: "from the side",
    ViewKind.BACK: "from behind",
}
_TURN_DEG = {ViewKind.FRONT: 0, ViewKind.SIDE: 90, ViewKind.BACK: 180}


def facing(capture: Capture) -> float | None:
    """Cosine of how far the trunk is turned from the camera, in [-1, 1].

    1 faces the camera, 0 is seen from the side, -1 from behind; None if a shoulder or a hip is
    missing.
    """
    pairs = ("shoulder", "hip")
    places = [capture.joints.get(f"{side}_{pair}") for pair in pairs for side in _SIDES]
    known = [each for each in places if each is not None]
    return trunk_facing(*known) if len(known) == len(places) else None


def seen_from(cosine: float) -> SeenFrom:
    """The view of a person who is turned by the arc of that cosine."""
    if abs(cosine) <= CLEARLY_TURNED:
        return SeenFrom.SIDE
    if abs(cosine) < LEAST_FRONTAL:
        return SeenFrom.BETWEEN
    return SeenFrom.FRONT if cosine > 0.0 else SeenFrom.BACK


def is_broadside(capture: Capture) -> bool:
    """Whether the person is seen from the front or from behind."""
    cosine = facing(capture)
    return cosine is not None and abs(cosine) >= LEAST_FRONTAL


def announced_view(capture: Capture) -> Remark | None:
    """Whether the person is seen from where they are said to be."""
    if capture.view is None or capture.view is ViewKind.OTHER:
        return None
    cosine = facing(capture)
    if cosine is None:
        return unchecked(Code.OTHER_VIEW, "Shoulders and hips are not all in the picture.")
    seen = seen_from(cosine)
    if seen.value == capture.view.value:
        return None
    return remark(
        Code.OTHER_VIEW,
        f"The person is to be seen {_SAID[capture.view]} and is turned from the camera by "
        f"about {math.degrees(math.acos(cosine)):.0f} degrees, where "
        f"{_TURN_DEG[capture.view]} are meant.",
        severity=Severity.HARMS if seen is SeenFrom.BETWEEN else Severity.BLOCKS,
        where=("left_shoulder", "right_shoulder", "left_hip", "right_hip"),
    )


LEAST_FREE = 0.3
"""Share of an arm below which it counts as lying against the trunk."""

LEAST_GAP = 0.01
"""Gap that can be seen, of the trunk's length: half a centimetre."""

_SIDES = {"left": "right", "right": "left"}
_UPPER_ARM, _FOREARM = np.linspace(0.5, 1.0, 6), np.linspace(0.1, 0.9, 8)
"""Shares of the bones at which the gap is looked for: below the armpit, and up to the wrist."""


def arms(capture: Capture) -> Remark | None:
    """Whether between trunk and arms, seen from the front or from behind, background shows."""
    if capture.mask is None:
        return unchecked(Code.ARMS_AGAINST_TRUNK, "Without a detector there is no outline.")
    if not is_broadside(capture):
        return unchecked(
            Code.ARMS_AGAINST_TRUNK,
            "Only from the front or from behind are arms seen beside the trunk.",
        )
    shares = {side: free_share(capture, capture.mask, side) for side in _SIDES}
    against = {
        side: share for side, share in shares.items() if share is not None and share < LEAST_FREE
    }
    if not against:
        return None
    said = " and ".join(f"{100.0 * share:.0f} % of the {side}" for side, share in against.items())
    return remark(
        Code.ARMS_AGAINST_TRUNK,
        f"Background shows between trunk and arm along {said} arm, from the armpit to the "
        f"wrist, where {100.0 * LEAST_FREE:.0f} % is the least.",
        severity=Severity.HARMS,
        where=tuple(f"{side}_{joint}" for side in against for joint in ("elbow", "wrist")),
    )


def free_share(capture: Capture, mask: Mask, side: str) -> float | None:
    """Share of an arm that background separates from the trunk; None if a joint is missing."""
    names = [f"{side}_{joint}" for joint in ("shoulder", "elbow", "wrist")]
    shoulders, hips = capture.middle("shoulder"), capture.middle("hip")
    if shoulders is None or hips is None or any(name not in capture.joints for name in names):
        return None
    shoulder, elbow, wrist = (capture.joints[name] for name in names)
    length = float(np.linalg.norm(hips - shoulders))
    if length == 0.0:
        return None
    along = (hips - shoulders) / length
    places = [shoulder + share * (elbow - shoulder) for share in _UPPER_ARM]
    places += [elbow + share * (wrist - elbow) for share in _FOREARM]
    gaps = [
        _gap(mask, place, shoulders + along * np.clip((place - shoulders) @ along, 0.0, length))
        for place in places
    ]
    return float(np.mean([gap >= LEAST_GAP * length for gap in gaps]))


def _gap(mask: Mask, start: Float[np.ndarray, "2"], end: Float[np.ndarray, "2"]) -> float:
    """Length of the background between two places, pixels."""
    distance = float(np.linalg.norm(end - start))
    steps = 2 * int(distance) + 2
    places = start + np.linspace(0.0, 1.0, steps)[:, None] * (end - start)
    columns = np.clip(places[:, 0].astype(int), 0, mask.shape[1] - 1)
    rows = np.clip(places[:, 1].astype(int), 0, mask.shape[0] - 1)
    background: Bool[np.ndarray, " s"] = ~mask[rows, columns]
    return distance * float(background.mean())
