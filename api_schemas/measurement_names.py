"""Which measurement a request may have meant by a name that there is not."""

from collections.abc import Mapping
from difflib import get_close_matches
from typing import Final

from fitter.vocabulary.measurements import MEASUREMENT_UNITS

OTHER_WORDS: Final[Mapping[str, str]] = {
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
    meant = [OTHER_WORDS.get(word, word) for word in words if len(word) > 2]
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
