"""Which points a fit can start from; checked before anything is stored or decoded.

These are the rules for the service. The fitter has the same for those who call it directly
(:mod:`fitter.observation.clicks`); a test keeps the two in step.
"""

import math
from collections.abc import Mapping

from pydantic_core import PydanticCustomError

from api_schemas.points import (
    LIMB_POINT_NAMES,
    MIN_EXTENT,
    MIN_LIMB_POINTS,
    MIN_TRUNK_POINTS,
    TRUNK_POINT_NAMES,
    Point,
    PointName,
    Points,
    PointsFormat,
    named_points,
)
from api_schemas.problems import FieldProblem
from service.submissions.refusal import refused


def checked_points(
    points: Points, layout: PointsFormat, *, width: int, height: int
) -> dict[PointName, Point]:
    """Translate the points to named pixels of the upright picture and check them.

    Raises
    ------
    RefusedError
        As :func:`placed_points`, or if they are too few or too close together.
    """
    named = placed_points(points, layout, width=width, height=height)
    _check_count(named)
    _check_extent(named, width=width, height=height)
    return named


def placed_points(
    points: Points, layout: PointsFormat, *, width: int, height: int
) -> dict[PointName, Point]:
    """Translate the points and check what can be checked before others are added.

    Raises
    ------
    RefusedError
        If the layout does not fit the points, or one lies outside the picture.
    """
    try:
        named = named_points(points, layout, width=width, height=height)
    except PydanticCustomError as error:
        context = error.context or {}
        raise refused(
            FieldProblem(
                field=str(context.get("field", "points")),
                code=error.type,
                reason=str(context.get("reason", error.message())),
                remedy=str(context.get("remedy", "")),
            )
        ) from error
    _check_places(named, width=width, height=height)
    return named


def _check_places(points: Mapping[PointName, Point], *, width: int, height: int) -> None:
    outside = tuple(
        FieldProblem(
            field=f"points.{name}",
            code="point-outside-image",
            reason=(
                f"({point.x:g}, {point.y:g}) lies outside the picture of {width} x {height} pixels."
            ),
            remedy=(
                "Give points in pixels of the picture as a browser shows it, at full size; leave "
                "out those beyond its border."
            ),
        )
        for name, point in points.items()
        if not (0.0 <= point.x <= width and 0.0 <= point.y <= height)
    )
    if outside:
        raise refused(*outside)


def _check_count(points: Mapping[PointName, Point]) -> None:
    limb_count = sum(name in points for name in LIMB_POINT_NAMES)
    trunk_count = sum(name in points for name in TRUNK_POINT_NAMES)
    if limb_count < MIN_LIMB_POINTS or trunk_count < MIN_TRUNK_POINTS:
        raise refused(
            FieldProblem(
                field="points",
                code="too-few-points",
                reason=(
                    f"There are {limb_count} limb points, {trunk_count} of them shoulders or hips."
                ),
                remedy=(
                    f"Click at least {MIN_LIMB_POINTS} of the shoulders, elbows, wrists, hips, "
                    f"knees and ankles, {MIN_TRUNK_POINTS} of them shoulders or hips."
                ),
            )
        )


def _check_extent(points: Mapping[PointName, Point], *, width: int, height: int) -> None:
    places = [(points[name].x, points[name].y) for name in LIMB_POINT_NAMES if name in points]
    extent = math.hypot(
        max(x for x, _ in places) - min(x for x, _ in places),
        max(y for _, y in places) - min(y for _, y in places),
    )
    if extent < MIN_EXTENT * math.hypot(width, height):
        raise refused(
            FieldProblem(
                field="points",
                code="points-too-close",
                reason=f"All limb points lie within {extent:.0f} pixels.",
                remedy="Give the points in pixels of the whole picture, or crop it to the person.",
            )
        )
