"""The names of all measurements and their units, for requests that name them.

They are those of the fitter's definitions (MEASUREMENTS.md), which a test compares with these: the
service checks names before it queues anything, in processes that load no fitter.
"""

from collections.abc import Mapping
from difflib import get_close_matches
from typing import Final

MEASUREMENT_UNITS: Final[Mapping[str, str]] = {
    "stature": "cm",
    "weight": "kg",
    "head_girth": "cm",
    "neck_girth": "cm",
    "neck_base_girth": "cm",
    "armscye_girth": "cm",
    "upper_chest_girth": "cm",
    "chest_girth": "cm",
    "under_bust_girth": "cm",
    "waist_girth_smallest": "cm",
    "waist_girth_navel": "cm",
    "abdomen_girth": "cm",
    "high_hip_girth": "cm",
    "hip_girth": "cm",
    "trunk_girth": "cm",
    "upper_arm_girth": "cm",
    "elbow_girth": "cm",
    "forearm_girth": "cm",
    "wrist_girth": "cm",
    "hand_girth": "cm",
    "thigh_girth": "cm",
    "mid_thigh_girth": "cm",
    "lower_thigh_girth": "cm",
    "knee_girth": "cm",
    "calf_girth": "cm",
    "ankle_girth": "cm",
    "shoulder_length": "cm",
    "back_shoulder_width": "cm",
    "cross_back": "cm",
    "cross_front": "cm",
    "bust_point_width": "cm",
    "neck_to_bust_point": "cm",
    "front_waist_length": "cm",
    "back_waist_length": "cm",
    "arm_length": "cm",
    "upper_arm_length": "cm",
    "forearm_length": "cm",
    "sleeve_length": "cm",
    "hand_length": "cm",
    "span": "cm",
    "waist_to_hip": "cm",
    "body_rise": "cm",
    "front_rise": "cm",
    "back_rise": "cm",
    "crotch_length": "cm",
    "inseam": "cm",
    "outseam": "cm",
    "foot_length": "cm",
    "head_height": "cm",
    "cervicale_height": "cm",
    "neck_height": "cm",
    "shoulder_height": "cm",
    "armpit_height": "cm",
    "chest_height": "cm",
    "waist_height": "cm",
    "hip_height": "cm",
    "knee_height": "cm",
    "ankle_height": "cm",
    "shoulder_breadth": "cm",
    "head_breadth": "cm",
    "head_depth": "cm",
    "chest_breadth": "cm",
    "chest_depth": "cm",
    "waist_breadth": "cm",
    "waist_depth": "cm",
    "hip_breadth": "cm",
    "hip_depth": "cm",
}

_OTHER_WORDS: Final[Mapping[str, str]] = {
    "bust": "chest",
    "seat": "hip",
    "hips": "hip",
    "height": "stature",
    "collar": "neck",
    "sleeve": "arm_length",
    "biceps": "upper_arm",
    "leg": "inseam",
    "mass": "weight",
}
"""What charts say, and what the names here have in its place."""

_MOST_SUGGESTED: Final = 3


def suggested_names(unknown: str) -> tuple[str, ...]:
    """Names that may have been meant by one that there is not, likeliest first; often none."""
    words = unknown.lower().replace("-", "_").replace(" ", "_").split("_")
    meant = [_OTHER_WORDS.get(word, word) for word in words if len(word) > 2]
    alike = get_close_matches("_".join(meant), MEASUREMENT_UNITS, n=_MOST_SUGGESTED, cutoff=0.75)
    holding = [
        name
        for name in MEASUREMENT_UNITS
        if any(word in name for word in meant if word not in ("girth", "length", "breadth"))
    ]
    return tuple(dict.fromkeys([*alike, *holding]))[:_MOST_SUGGESTED]


def unknown_name_remedy(unknown: str) -> str:
    """What to send in place of a name that there is not."""
    suggested = suggested_names(unknown)
    if suggested:
        return f"Did you mean {' or '.join(suggested)}? MEASUREMENTS.md lists all names."
    return f"Use one of {', '.join(MEASUREMENT_UNITS)}."
