"""Ranges of joints, and their usual angles: one table.

Limits are published ranges of motion from the anatomical position, degrees. Every direction of
every joint names where its two limits come from:

- AAOS: American Academy of Orthopaedic Surgeons, "Joint Motion: Method of Measuring and
  Recording" (1965), and its successor, W. B. Greene and J. D. Heckman, "The Clinical Measurement
  of Joint Motion" (1994); tabulated in C. C. Norkin and D. J. White, "Measurement of Joint Motion:
  A Guide to Goniometry", appendix A.
- Kapandji: I. A. Kapandji, "The Physiology of the Joints", volumes 1 to 3.

Where the textbooks know no motion, as across a hinge, the source says "ours": a few degrees for
the slack of ligaments and for joint centres and bone axes that are a little off. Where two of our
joints share one of theirs, the limits add up to the published ones.

Means and standard deviations are ours: an upright, relaxed person, and about a fifth of the range,
less where the motion is passive or rare. They are deliberately firm. Clicked points alone leave
twists and depths almost free, and without a firm prior joints turn by 20 to 100 degrees to
explain a few pixels of click noise.

Directions. *Flexion*: limbs, trunk and head forward; shin backward; foot upward. *Abduction*:
limbs and foot away from the body's middle; trunk and head to the left. *Twist* about the bone:
limbs outward (external rotation, supination), foot with the sole inward (inversion), trunk and head
to the left. Left and right share one row.

Pronation and supination are the hand's: the radius turns about the ulna, so that the skin of the
forearm follows the hand's twist the more the nearer it is to the wrist, and not at all at the
elbow.
"""

from collections.abc import Mapping
from dataclasses import dataclass


@dataclass(frozen=True, slots=True, kw_only=True)
class Motion:
    """One direction of motion, degrees from the anatomical position, and where it comes from."""

    lower: float
    upper: float
    mean: float
    standard_deviation: float
    source: str


@dataclass(frozen=True, slots=True, kw_only=True)
class JointRange:
    """The three directions in which a part turns relative to its parent."""

    flexion: Motion
    abduction: Motion
    twist: Motion


def _motion(
    lower: float, upper: float, mean: float, standard_deviation: float, source: str
) -> Motion:
    return Motion(
        lower=lower,
        upper=upper,
        mean=mean,
        standard_deviation=standard_deviation,
        source=source,
    )


_TRUNK_ROTATION = "Kapandji 3: thoracic rotation 35, lumbar 5, 40 shared between spine and chest"
_CERVICAL_FLEXION = "Kapandji 3: cervical extension 75, flexion 40, shared between neck and head"
_CERVICAL_LEANING = "Kapandji 3: cervical lateral flexion 45, shared between neck and head"
_CERVICAL_ROTATION = (
    "Kapandji 3: rotation of the head 80, half of it at atlas and axis: shared by neck and head"
)
_SLACK = "ours: slack of a hinge"

JOINT_RANGES: Mapping[str, JointRange] = {
    "spine": JointRange(
        flexion=_motion(-35, 60, 2, 10, "Kapandji 3: lumbar extension 35, flexion 60"),
        abduction=_motion(-20, 20, 0, 7, "Kapandji 3: lumbar lateral flexion 20"),
        twist=_motion(-15, 15, 0, 6, _TRUNK_ROTATION),
    ),
    "chest": JointRange(
        flexion=_motion(-25, 45, 2, 8, "Kapandji 3: thoracic extension 25, flexion 45"),
        abduction=_motion(-20, 20, 0, 7, "Kapandji 3: thoracic lateral flexion 20"),
        twist=_motion(-25, 25, 0, 8, _TRUNK_ROTATION),
    ),
    "neck": JointRange(
        flexion=_motion(-45, 26, 5, 12, _CERVICAL_FLEXION),
        abduction=_motion(-35, 35, 0, 10, _CERVICAL_LEANING),
        twist=_motion(-40, 40, 0, 16, _CERVICAL_ROTATION),
    ),
    "head": JointRange(
        flexion=_motion(-30, 14, 0, 10, _CERVICAL_FLEXION),
        abduction=_motion(-10, 10, 0, 5, _CERVICAL_LEANING),
        twist=_motion(-40, 40, 0, 16, _CERVICAL_ROTATION),
    ),
    "upper_arm": JointRange(
        flexion=_motion(-60, 180, 8, 35, "AAOS: shoulder extension 60, flexion 180"),
        abduction=_motion(
            -45, 180, 15, 30, "Kapandji 1: adduction before the trunk 45; AAOS: abduction 180"
        ),
        twist=_motion(-70, 90, 0, 30, "AAOS: shoulder internal rotation 70, external 90"),
    ),
    "forearm": JointRange(
        flexion=_motion(-5, 150, 25, 35, "Kapandji 1: hyperextension 5; AAOS: elbow flexion 150"),
        abduction=_motion(-8, 8, 0, 3, _SLACK),
        twist=_motion(-8, 8, 0, 3, _SLACK),
    ),
    "hand": JointRange(
        flexion=_motion(-70, 80, 5, 15, "AAOS: wrist extension 70, flexion 80"),
        abduction=_motion(-30, 20, 0, 8, "AAOS: ulnar deviation 30, radial deviation 20"),
        twist=_motion(-80, 80, 0, 30, "AAOS: pronation 80, supination 80"),
    ),
    "thigh": JointRange(
        flexion=_motion(-30, 120, 8, 25, "AAOS: hip extension 30, flexion 120"),
        abduction=_motion(-30, 45, 2, 10, "AAOS: hip adduction 30, abduction 45"),
        twist=_motion(-45, 45, 5, 15, "AAOS: hip internal rotation 45, external 45"),
    ),
    "shin": JointRange(
        flexion=_motion(
            -5, 150, 10, 25, "Kapandji 2: knee hyperextension 5, flexion 140 active, 160 passive"
        ),
        abduction=_motion(-6, 6, 0, 3, _SLACK),
        twist=_motion(-30, 40, 0, 5, "Kapandji 2: bent knee, medial rotation 30, lateral 40"),
    ),
    "foot": JointRange(
        flexion=_motion(-50, 20, -2, 14, "AAOS: plantar flexion 50, dorsiflexion 20"),
        abduction=_motion(
            -20, 20, 0, 8, "Kapandji 2: adduction and abduction of the foot 35 to 45 in all"
        ),
        twist=_motion(-15, 35, 0, 8, "AAOS: eversion 15, inversion 35"),
    ),
}
"""By part name without its side. The pelvis is free: pictures show people from anywhere."""

LIMIT_SOFTNESS_DEG = 3.0
"""Standard deviation of an excursion beyond a limit: people vary, and tables are rounded."""


def side_of(part_name: str) -> int:
    """1 for a left part, -1 for a right one, 0 for the trunk and head."""
    if part_name.startswith("left_"):
        return 1
    return -1 if part_name.startswith("right_") else 0


def range_of(part_name: str) -> JointRange | None:
    """The range of a part by its full name, None for a part that turns freely."""
    return JOINT_RANGES.get(part_name.removeprefix("left_").removeprefix("right_"))
