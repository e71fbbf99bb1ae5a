"""Measurements in groups, as people look for them: told by the name alone."""

from enum import StrEnum


class Group(StrEnum):
    """Headings, in order."""

    OVERALL = "Stature and weight"
    GIRTHS = "Girths"
    LENGTHS = "Lengths"
    HEIGHTS = "Heights"
    BREADTHS = "Breadths and depths"


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
