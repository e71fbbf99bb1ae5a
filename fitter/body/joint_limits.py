"""How far joints turn, and where they usually are: one table.

Limits are the textbooks' ranges of active motion from the anatomical position, degrees:

- AAOS: American Academy of Orthopaedic Surgeons, "Joint Motion: Method of Measuring and
  Recording" (1965), and its successor, W. B. Greene and J. D. Heckman, "The Clinical Measurement
  of Joint Motion" (1994).
- Kapandji: I. A. Kapandji, "The Physiology of the Joints", volumes 1 to 3.

Means and standard deviations are ours: an upright, relaxed person, and about a fifth of the range,
less where the motion is passive or rare. They are deliberately firm. Clicked points alone leave
twists and depths almost free, and without a firm prior joints turn by 20 to 100 degrees to
explain a few pixels of click noise.

Directions. *Flexion*: limbs, trunk and head forward; shin backward; foot upward. *Abduction*:
limbs and foot away from the body's middle; trunk and head to the left. *Twist* about the bone:
limbs outward (external rotation, supination), foot with the sole inward (inversion), trunk and head
to the left. Left and right share one row.
"""

from collections.abc import Mapping
from dataclasses import dataclass


@dataclass(frozen=True, slots=True, kw_only=True)
class Motion:
    """One direction of motion, degrees from the anatomical position."""

    lower: float
    upper: float
    mean: float
    standard_deviation: float


@dataclass(frozen=True, slots=True, kw_only=True)
class JointRange:
    """The three directions in which a part turns relative to its parent."""

    flexion: Motion
    abduction: Motion
    twist: Motion
    source: str


def _motion(lower: float, upper: float, mean: float, standard_deviation: float) -> Motion:
    return Motion(lower=lower, upper=upper, mean=mean, standard_deviation=standard_deviation)


JOINT_RANGES: Mapping[str, JointRange] = {
    "spine": JointRange(
        flexion=_motion(-35, 60, 2, 10),
        abduction=_motion(-20, 20, 0, 7),
        twist=_motion(-15, 15, 0, 6),
        source=(
            "Kapandji 3, lumbar spine: flexion 60, extension 35, lateral 20; of the 40 degrees of "
            "thoracolumbar rotation (5 lumbar, 35 thoracic) the share below the chest joint"
        ),
    ),
    "chest": JointRange(
        flexion=_motion(-25, 45, 2, 8),
        abduction=_motion(-20, 20, 0, 7),
        twist=_motion(-25, 25, 0, 8),
        source="Kapandji 3, thoracic spine: flexion 45, extension 25, lateral 20, rotation 35",
    ),
    "neck": JointRange(
        flexion=_motion(-45, 30, 5, 12),
        abduction=_motion(-35, 35, 0, 10),
        twist=_motion(-40, 40, 0, 16),
        source=(
            "Kapandji 3, cervical spine: flexion 40, extension 75, lateral 45, rotation 80; shared "
            "between neck and head, half of the rotation at atlas and axis"
        ),
    ),
    "head": JointRange(
        flexion=_motion(-30, 15, 0, 10),
        abduction=_motion(-10, 10, 0, 5),
        twist=_motion(-40, 40, 0, 16),
        source="as the neck",
    ),
    "upper_arm": JointRange(
        flexion=_motion(-60, 180, 8, 35),
        abduction=_motion(-45, 180, 15, 30),
        twist=_motion(-70, 90, 0, 30),
        source=(
            "AAOS, shoulder with shoulder girdle: flexion 180, extension 60, abduction 180, "
            "rotation 70 inward, 90 outward; Kapandji 1: adduction in front of the trunk 45"
        ),
    ),
    "forearm": JointRange(
        flexion=_motion(-5, 150, 25, 35),
        abduction=_motion(-8, 8, 0, 3),
        twist=_motion(-80, 80, 0, 30),
        source="AAOS: elbow flexion 150, hyperextension to 5; pronation 80, supination 80",
    ),
    "hand": JointRange(
        flexion=_motion(-70, 80, 5, 15),
        abduction=_motion(-20, 30, 0, 8),
        twist=_motion(-8, 8, 0, 3),
        source="AAOS, wrist: flexion 80, extension 70, radial deviation 20, ulnar deviation 30",
    ),
    "thigh": JointRange(
        flexion=_motion(-30, 120, 8, 25),
        abduction=_motion(-30, 45, 2, 10),
        twist=_motion(-45, 45, 5, 15),
        source=(
            "AAOS, hip: flexion 120, extension 30, abduction 45, adduction 30, rotation 45 each way"
        ),
    ),
    "shin": JointRange(
        flexion=_motion(-5, 150, 10, 25),
        abduction=_motion(-6, 6, 0, 3),
        twist=_motion(-10, 10, 0, 5),
        source=(
            "Kapandji 2, knee: flexion 140 active to 160 passive, hyperextension 5; axial rotation "
            "only when bent"
        ),
    ),
    "foot": JointRange(
        flexion=_motion(-50, 20, -2, 14),
        abduction=_motion(-20, 20, 0, 8),
        twist=_motion(-15, 35, 0, 8),
        source="AAOS, ankle: dorsiflexion 20, plantar flexion 50; inversion 35, eversion 15",
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
