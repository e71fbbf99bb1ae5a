"""The clicked points: which are enough, where they may lie, and whether left and right agree."""

import math
from collections.abc import Mapping

from fitter.errors import InvalidInputError
from fitter.remarks import FitWarning
from fitter.request import Click
from fitter.vocabulary.points import CLEAR_BREADTH, PointFault, place_faults, shortage


def check_clicks(clicks: Mapping[str, Click], *, width: int, height: int) -> None:
    """Refuse points that cannot be used; the picture's size is that of the upright original.

    Raises
    ------
    InvalidInputError
        ``point-unknown``, ``point-not-finite``, ``point-outside-image``, ``too-few-points`` or
        ``points-too-close``.
    """
    check_places(clicks, width=width, height=height)
    fault = shortage(_places(clicks), width=width, height=height)
    if fault is not None:
        raise _refusal(fault)


def check_places(clicks: Mapping[str, Click], *, width: int, height: int) -> None:
    """Refuse points of unknown names and such as lie outside the picture.

    Raises
    ------
    InvalidInputError
        ``point-unknown``, ``point-not-finite`` or ``point-outside-image``.
    """
    for fault in place_faults(_places(clicks), width=width, height=height):
        raise _refusal(fault)


def side_warnings(clicks: Mapping[str, Click]) -> tuple[FitWarning, ...]:
    """Warnings where left and right contradict each other.

    With the trunk upright, the left of a person seen from the front lies to the right, and of one
    seen from behind to the left. Shoulders and hips must agree, and a person who shows both eyes
    is seen from the front. Legs and arms may cross; one eye or a nose may be looking over a
    shoulder.
    """
    trunk = _trunk(clicks)
    if trunk is None:
        return ()
    breadth = CLEAR_BREADTH * math.hypot(*trunk)
    shoulders = _seen_from_front(clicks, "shoulder", trunk, breadth=breadth)
    hips = _seen_from_front(clicks, "hip", trunk, breadth=breadth)
    if None not in (shoulders, hips) and shoulders != hips:
        return (
            FitWarning(
                code="shoulders-and-hips-disagree",
                message=(
                    "By the shoulders the person is seen from one side, by the hips from the "
                    "other: left and right may be swapped in one pair. They are the person's own."
                ),
            ),
        )
    trunk_from_front = hips if shoulders is None else shoulders
    eyes_from_front = None
    if _seen(clicks, "left_eye") and _seen(clicks, "right_eye"):
        eyes_from_front = _seen_from_front(clicks, "eye", trunk, breadth=0.0)
    if eyes_from_front is not None and False in (trunk_from_front, eyes_from_front):
        return (
            FitWarning(
                code="left-and-right-may-be-swapped",
                message=(
                    "Both eyes are seen, but left and right are as from behind: they may be "
                    "swapped. They are the person's own."
                ),
            ),
        )
    return ()


def _places(clicks: Mapping[str, Click]) -> dict[str, tuple[float, float]]:
    return {name: (click.x, click.y) for name, click in clicks.items()}


def _refusal(fault: PointFault) -> InvalidInputError:
    return InvalidInputError(
        code=fault.code, field=fault.field, reason=fault.reason, remedy=fault.remedy
    )


def _trunk(clicks: Mapping[str, Click]) -> tuple[float, float] | None:
    """From shoulder to hip, pixels, the mean of the sides given."""
    sides = [
        (clicks[f"{side}_shoulder"], clicks[f"{side}_hip"])
        for side in ("left", "right")
        if f"{side}_shoulder" in clicks and f"{side}_hip" in clicks
    ]
    if not sides:
        return None
    return (
        sum(hip.x - shoulder.x for shoulder, hip in sides) / len(sides),
        sum(hip.y - shoulder.y for shoulder, hip in sides) / len(sides),
    )


def _seen(clicks: Mapping[str, Click], name: str) -> bool:
    return name in clicks and not clicks[name].occluded


def _seen_from_front(
    clicks: Mapping[str, Click], pair: str, trunk: tuple[float, float], *, breadth: float
) -> bool | None:
    """Whether the left one of a pair lies to the right of the trunk's axis; None if not clear."""
    left, right = clicks.get(f"left_{pair}"), clicks.get(f"right_{pair}")
    length = math.hypot(*trunk)
    if left is None or right is None or length == 0.0:
        return None
    down_x, down_y = trunk[0] / length, trunk[1] / length
    across = (left.x - right.x) * down_y - (left.y - right.y) * down_x
    return across > 0.0 if abs(across) >= breadth else None
