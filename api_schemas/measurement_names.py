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
    "chest_girth": "cm",
    "waist_girth_navel": "cm",
    "waist_girth_smallest": "cm",
    "hip_girth": "cm",
    "neck_girth": "cm",
    "head_girth": "cm",
    "thigh_girth": "cm",
    "calf_girth": "cm",
    "ankle_girth": "cm",
    "upper_arm_girth": "cm",
    "forearm_girth": "cm",
    "wrist_girth": "cm",
    "shoulder_breadth": "cm",
    "arm_length": "cm",
    "inseam": "cm",
    "back_waist_length": "cm",
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
