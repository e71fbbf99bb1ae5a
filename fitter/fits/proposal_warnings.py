"""What somebody looking at proposed points should know about them."""

from collections.abc import Iterator, Mapping, Sequence
from itertools import pairwise

from fitter.capture.capture import MASK_LEVEL, joints_of, stature_px
from fitter.capture.framing import LEAST_STATURE_PX, points_beyond
from fitter.detection.detector import DetectedBody
from fitter.remarks import FitWarning
from fitter.request import Click

FACE = ("nose", "left_eye", "right_eye")

Segment = tuple[Click, Click]

CHAINS = {
    "arms": ("shoulder", "elbow", "wrist"),
    "legs": ("hip", "knee", "ankle"),
}
"""Joints of arms and legs, from the trunk outward."""


def proposal_warnings(
    bodies: Sequence[DetectedBody], chosen: int | None, *, was_chosen: bool
) -> tuple[FitWarning, ...]:
    """Warnings of a proposal; everything is in pixels of the working picture.

    Parameters
    ----------
    bodies
        Everybody found.
    chosen
        Index of the one whose points are proposed; None if nobody was found.
    was_chosen
        Whether the caller chose the person.
    """
    if chosen is None:
        return (
            FitWarning(
                code="nobody-found",
                message="No person was found in the picture: click the points.",
            ),
        )
    body = bodies[chosen]
    found = {
        "several-people": (
            len(bodies) > 1 and not was_chosen,
            (
                f"{len(bodies)} people were found; the points are the largest one's. Send `person` "
                "for another one's."
            ),
        ),
        "cut-off": (
            _is_cut_off(body),
            (
                "The person reaches to the picture's border or beyond it: points that are not in "
                "the picture are left out."
            ),
        ),
        "person-too-small": (
            _is_small(body),
            (
                "The person is so small that measurements suffer: crop the picture to the person, "
                "or send a larger one."
            ),
        ),
        "seen-from-behind": (
            _is_from_behind(body.points),
            "The person seems to be seen from behind: see whether left and right are theirs.",
        ),
        "limbs-crossed": (
            any(_are_crossed(body.points, chain) for chain in CHAINS.values()),
            "Arms or legs cross in the picture: see whether left and right are the right ones.",
        ),
    }
    return tuple(
        FitWarning(code=code, message=message) for code, (holds, message) in found.items() if holds
    )


def _is_cut_off(body: DetectedBody) -> bool:
    """Whether a point lies outside the picture, or the mask reaches its border."""
    mask = body.mask >= MASK_LEVEL
    return bool(points_beyond(joints_of(body.points), mask, mask.shape))


def _is_small(body: DetectedBody) -> bool:
    tall = stature_px(joints_of(body.points), body)
    return tall is not None and tall < LEAST_STATURE_PX


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
