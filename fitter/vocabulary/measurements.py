"""The names of all measurements, their units and groups.

``fitter/measurement/definitions.json`` has them. It is read here without the code that measures by
it, so that names can be checked where no numerics are loaded.
"""

import json
from collections.abc import Mapping
from enum import StrEnum
from importlib.resources import files
from types import MappingProxyType
from typing import Final

STATURE: Final = "stature"
"""The measurement that a request's ``height_m`` is in metres."""

WEIGHT: Final = "weight"

CENTIMETRES_PER_METRE: Final = 100.0

LEAST_HEIGHT_M: Final = 1.2
MOST_HEIGHT_M: Final = 2.3
"""Bounds on a height in any request. A height that is within and yet unusual is taken with a
warning (:mod:`fitter.population.conditional_shape`)."""


def _units() -> Mapping[str, str]:
    text = files("fitter.measurement").joinpath("definitions.json").read_text(encoding="utf-8")
    return MappingProxyType(
        {each["name"]: each["unit"] for each in json.loads(text)["measurements"]}
    )


MEASUREMENT_UNITS: Final = _units()
"""The unit, ``cm`` or ``kg``, of each measurement by its name, in the order they are listed."""


class Group(StrEnum):
    """Headings, in order."""

    OVERALL = "Stature and weight"
    GIRTHS = "Girths"
    LENGTHS = "Lengths"
    HEIGHTS = "Heights"
    BREADTHS = "Breadths and depths"


CHIEF = (
    "stature",
    "weight",
    "head_girth",
    "neck_girth",
    "chest_girth",
    "under_bust_girth",
    "waist_girth_smallest",
    "waist_girth_navel",
    "hip_girth",
    "upper_arm_girth",
    "forearm_girth",
    "wrist_girth",
    "thigh_girth",
    "knee_girth",
    "calf_girth",
    "ankle_girth",
    "shoulder_breadth",
    "back_shoulder_width",
    "arm_length",
    "sleeve_length",
    "back_waist_length",
    "crotch_length",
    "inseam",
    "outseam",
)
"""Measurements that most people ask for: shown first, where all are too many."""

_OVERALL = ("stature", "weight")


def group_of(name: str) -> Group:
    """The group of a measurement; names tell what they are."""
    if name in _OVERALL:
        return Group.OVERALL
    if "girth" in name.split("_"):
        return Group.GIRTHS
    if name.endswith("_height"):
        return Group.HEIGHTS
    if name.endswith(("_breadth", "_depth")):
        return Group.BREADTHS
    return Group.LENGTHS
