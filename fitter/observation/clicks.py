"""The clicked points: which are enough, where they may lie, and whether left and right agree."""

import math
from collections.abc import Mapping

from fitter.errors import InvalidInputError
from fitter.remarks import FitWarning
from fitter.request import Click

LIMB_POINTS = (
    "left_shoulder", "right_shoulder", "left_elbow", "right_elbow", "left_wrist", "right_wrist",
    "left_hip", "right_hip", "left_knee", "right_knee", "left_ankle", "right_ankle",
)  # fmt: skip
FACE_POINTS = ("nose", "left_eye", "right_eye", "left_ear", "right_ear")
FURTHER_POINTS = (
    "neck", "head_top", "chin", "left_toe", "right_toe", "left_heel", "right_heel",
)  # fmt: skip
POINT_NAMES = (*FACE_POINTS, *LIMB_POINTS, *FURTHER_POINTS)
TRUNK_POINTS = ("left_shoulder", "right_shoulder", "left_hip", "right_hip")

LEAST_LIMB_POINTS = 6
LEAST_TRUNK_POINTS = 2
"""Two trunk points and six limb points in all leave at least two whole limbs: a root to hang the
body on, and lengths to find its depth from. A seated half figure has them, a head does not."""

LEAST_EXTENT = 0.05
"""Points spread over less than this share of the picture's diagonal are no person to measure."""

CLEAR_BREADTH = 0.2
"""A pair of joints tells left from right when its horizontal distance exceeds this share of the
trunk's length: nearer to profile, a few pixels of clicking error decide the order."""

_MINIMUM = (
    f"Click at least {LEAST_LIMB_POINTS} of the shoulders, elbows, wrists, hips, knees and ankles, "
    f"{LEAST_TRUNK_POINTS} of them shoulders or hips."
)


def check_clicks(clicks: Mapping[str, Click], *, width: int, height: int) -> None:
    """Refuse points that cannot be used; the picture's size is that of the upright original.

    Raises
    ------
    InvalidInputError
        ``point-unknown``, ``point-not-finite``, ``point-outside-image``, ``too-few-points`` or
        ``points-too-close``.
    """
    check_places(clicks, width=width, height=height)
    limb_count = sum(name in clicks for name in LIMB_POINTS)
    trunk_count = sum(name in clicks for name in TRUNK_POINTS)
    if limb_count < LEAST_LIMB_POINTS or trunk_count < LEAST_TRUNK_POINTS:
        raise InvalidInputError(
            code="too-few-points",
            field="points",
            reason=(
                f"{limb_count} limb points are given, {trunk_count} of them shoulders or hips."
            ),
            remedy=_MINIMUM,
        )
    places = [(clicks[name].x, clicks[name].y) for name in LIMB_POINTS if name in clicks]
    extent = math.hypot(
        max(x for x, _ in places) - min(x for x, _ in places),
        max(y for _, y in places) - min(y for _, y in places),
    )
    if extent < LEAST_EXTENT * math.hypot(width, height):
        raise InvalidInputError(
            code="points-too-close",
            field="points",
            reason=f"All limb points lie within {extent:.0f} pixels.",
            remedy="Give the points in pixels of the whole picture, or crop it to the person.",
        )


def check_places(clicks: Mapping[str, Click], *, width: int, height: int) -> None:
    """Refuse points of unknown names and such as lie outside the picture.

    Raises
    ------
    InvalidInputError
        ``point-unknown``, ``point-not-finite`` or ``point-outside-image``.
    """
    for name, click in clicks.items():
        _check_click(name, click, width=width, height=height)


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


def _check_click(name: str, click: Click, *, width: int, height: int) -> None:
    if name not in POINT_NAMES:
        raise InvalidInputError(
            code="point-unknown",
            field=f"points.{name}",
            reason="There is no point of this name.",
            remedy=f"Use one of {', '.join(POINT_NAMES)}.",
        )
    if not (math.isfinite(click.x) and math.isfinite(click.y)):
        raise InvalidInputError(
            code="point-not-finite",
            field=f"points.{name}",
            reason="A coordinate is not a finite number.",
            remedy="Leave out points that are not known.",
        )
    if not (0.0 <= click.x <= width and 0.0 <= click.y <= height):
        raise InvalidInputError(
            code="point-outside-image",
            field=f"points.{name}",
            reason=(
                f"({click.x:g}, {click.y:g}) lies outside the upright picture of "
                f"{width} x {height} pixels."
            ),
            remedy=(
                "Give points in pixels of the picture as a browser shows it, at full size; leave "
                "out those beyond its border."
            ),
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
