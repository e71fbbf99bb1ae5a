"""What somebody looking at proposed points should know about them."""

from collections.abc import Iterator, Mapping, Sequence
from itertools import pairwise

from fitter.remarks import FitWarning
from fitter.request import Click

FACE = ("nose", "left_eye", "right_eye")

Segment = tuple[Click, Click]

CHAINS = {
    "arms": ("shoulder", "elbow", "wrist"),
    "legs": ("hip", "knee", "ankle"),
}
"""Joints of arms and legs, from the trunk outward."""


def proposal_warnings(points: Mapping[str, Click]) -> tuple[FitWarning, ...]:
    """Warnings of proposed points; everything is in pixels of the working picture."""
    found = {
        "seen-from-behind": (
            _is_from_behind(points),
            "The person seems to be seen from behind: see whether left and right are theirs.",
        ),
        "limbs-crossed": (
            any(_are_crossed(points, chain) for chain in CHAINS.values()),
            "Arms or legs cross in the picture: see whether left and right are the right ones.",
        ),
    }
    return tuple(
        FitWarning(code=code, message=message) for code, (holds, message) in found.items() if holds
    )


def _is_from_behind(points: Mapping[str, Click]) -> bool:
    left, right = points.get("left_shoulder"), points.get("right_shoulder")
    if left is None or right is None or left.x >= right.x:
        return False
    return all(name not in points or points[name].occluded for name in FACE)


def _are_crossed(points: Mapping[str, Click], chain: Sequence[str]) -> bool:
    """Whether a part of the left limb crosses one of the right limb."""
    return any(
        _cross(one, other)
        for one in _segments(points, "left", chain)
        for other in _segments(points, "right", chain)
    )


def _segments(points: Mapping[str, Click], side: str, chain: Sequence[str]) -> Iterator[Segment]:
    """The parts of a limb whose two ends are both known."""
    for near, far in pairwise(points.get(f"{side}_{joint}") for joint in chain):
        if near is not None and far is not None:
            yield near, far


def _cross(one: Segment, other: Segment) -> bool:
    """Whether two segments have an inner point in common."""
    return (
        _turn(*one, other[0]) * _turn(*one, other[1]) < 0.0
        and _turn(*other, one[0]) * _turn(*other, one[1]) < 0.0
    )


def _turn(start: Click, end: Click, point: Click) -> float:
    """Twice the signed area of a triangle.

    Positive where ``point`` lies to the right of the way from start to end, as seen in the picture.
    """
    return (end.x - start.x) * (point.y - start.y) - (end.y - start.y) * (point.x - start.x)
