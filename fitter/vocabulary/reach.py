"""Which values of a measurement people have, and which other unit a value seems to be in.

For sizes and charts, whose units are judged where no body model is loaded.
"""

from collections.abc import Mapping, Sequence
from typing import Final

from fitter.vocabulary.measurements import MEASUREMENT_UNITS

OTHER_UNITS: Final[Mapping[str, Sequence[tuple[float, str]]]] = {
    "cm": ((100.0, "metres"), (0.1, "millimetres"), (2.54, "inches")),
    "kg": ((0.453_592, "pounds"), (6.350_29, "stones"), (0.001, "grams")),
}
"""By unit: the factors that convert a value given in another one."""

USUAL_REACH: Final[Mapping[str, tuple[float, float]]] = {
    "stature": (139.0, 197.0),
    "weight": (31.0, 161.0),
    "head_girth": (51.0, 62.0),
    "neck_girth": (27.0, 50.0),
    "neck_base_girth": (27.0, 59.0),
    "armscye_girth": (25.0, 56.0),
    "upper_chest_girth": (68.0, 146.0),
    "chest_girth": (64.0, 146.0),
    "under_bust_girth": (55.0, 142.0),
    "waist_girth_smallest": (50.0, 144.0),
    "waist_girth_navel": (51.0, 147.0),
    "abdomen_girth": (59.0, 149.0),
    "high_hip_girth": (60.0, 148.0),
    "hip_girth": (71.0, 144.0),
    "trunk_girth": (126.0, 195.0),
    "upper_arm_girth": (18.0, 46.0),
    "elbow_girth": (17.0, 32.0),
    "forearm_girth": (19.0, 39.0),
    "wrist_girth": (12.0, 21.0),
    "hand_girth": (16.0, 24.0),
    "thigh_girth": (37.0, 94.0),
    "mid_thigh_girth": (28.0, 86.0),
    "lower_thigh_girth": (29.0, 60.0),
    "knee_girth": (27.0, 54.0),
    "calf_girth": (26.0, 51.0),
    "ankle_girth": (16.0, 28.0),
    "shoulder_length": (10.0, 18.0),
    "back_shoulder_width": (33.0, 53.0),
    "cross_back": (30.0, 50.0),
    "cross_front": (29.0, 49.0),
    "bust_point_width": (11.0, 28.0),
    "neck_to_bust_point": (22.0, 39.0),
    "front_waist_length": (30.0, 49.0),
    "back_waist_length": (35.0, 56.0),
    "arm_length": (45.0, 71.0),
    "upper_arm_length": (24.0, 40.0),
    "forearm_length": (19.0, 32.0),
    "sleeve_length": (63.0, 96.0),
    "hand_length": (13.0, 21.0),
    "span": (141.0, 216.0),
    "waist_to_hip": (5.0, 23.0),
    "body_rise": (13.0, 27.0),
    "front_rise": (17.0, 33.0),
    "back_rise": (23.0, 46.0),
    "crotch_length": (43.0, 76.0),
    "inseam": (61.0, 99.0),
    "outseam": (79.0, 123.0),
    "foot_length": (20.0, 32.0),
    "head_height": (18.0, 25.0),
    "cervicale_height": (118.0, 171.0),
    "neck_height": (111.0, 163.0),
    "shoulder_height": (112.0, 166.0),
    "armpit_height": (101.0, 150.0),
    "chest_height": (95.0, 147.0),
    "waist_height": (78.0, 121.0),
    "hip_height": (67.0, 106.0),
    "knee_height": (36.0, 58.0),
    "ankle_height": (5.0, 9.0),
    "shoulder_breadth": (30.0, 49.0),
    "head_breadth": (14.0, 17.0),
    "head_depth": (17.0, 22.0),
    "chest_breadth": (21.0, 50.0),
    "chest_depth": (14.0, 41.0),
    "waist_breadth": (18.0, 48.0),
    "waist_depth": (11.0, 45.0),
    "hip_breadth": (27.0, 52.0),
    "hip_depth": (15.0, 40.0),
}
"""Where 99.7 % of the people of the packaged models lie, women and men, cm or kg: 3 standard
deviations either way, which a test takes from the models."""


def other_unit(name: str, values: Sequence[float]) -> tuple[float, str] | None:
    """The factor and the name of the unit that all values of a measurement seem to be in.

    None where one of them is a usual value as it stands: there may be sizes for nobody usual.
    """
    low, high = USUAL_REACH[name]
    if any(low <= value <= high for value in values):
        return None
    middle = sorted(values)[len(values) // 2]
    for factor, unit in OTHER_UNITS[MEASUREMENT_UNITS[name]]:
        if low <= factor * middle <= high:
            return factor, unit
    return None
