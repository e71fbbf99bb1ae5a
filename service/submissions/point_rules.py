"""Which points a fit can start from; checked before anything is stored or decoded.

The rules are those of :mod:`fitter.vocabulary.points`, as the fitter applies them.
"""

from collections.abc import Mapping

from pydantic_core import PydanticCustomError

from api_schemas.points import Point, Points, PointsFormat, named_points
from api_schemas.problems import FieldProblem
from fitter.vocabulary.points import PointFault, PointName, place_faults, shortage
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
    fault = shortage(_places(named), width=width, height=height)
    if fault is not None:
        raise refused(_problem(fault))
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
    outside = [
        _problem(fault) for fault in place_faults(_places(named), width=width, height=height)
    ]
    if outside:
        raise refused(*outside)
    return named


def _places(points: Mapping[PointName, Point]) -> dict[str, tuple[float, float]]:
    return {name: (point.x, point.y) for name, point in points.items()}


def _problem(fault: PointFault) -> FieldProblem:
    return FieldProblem(
        field=fault.field, code=fault.code, reason=fault.reason, remedy=fault.remedy
    )
