"""The service's rule for points is the fitter's."""

import pytest

from api_schemas.points import (
    CLEAR_BREADTH,
    LIMB_POINT_NAMES,
    MIN_EXTENT,
    MIN_LIMB_POINTS,
    MIN_TRUNK_POINTS,
    POINT_NAMES,
    TRUNK_POINT_NAMES,
    PointsFormat,
)
from fitter.errors import InvalidInputError
from fitter.observation import clicks as fitter_rule
from fitter.request import Click
from service.submissions.point_rules import checked_points
from service.submissions.refusal import RefusedError


def test_both_rules_have_the_same_names_and_numbers():
    assert set(LIMB_POINT_NAMES) == set(fitter_rule.LIMB_POINTS)
    assert set(TRUNK_POINT_NAMES) == set(fitter_rule.TRUNK_POINTS)
    assert set(POINT_NAMES) == set(fitter_rule.POINT_NAMES)
    assert MIN_LIMB_POINTS == fitter_rule.LEAST_LIMB_POINTS
    assert MIN_TRUNK_POINTS == fitter_rule.LEAST_TRUNK_POINTS
    assert MIN_EXTENT == fitter_rule.LEAST_EXTENT
    assert CLEAR_BREADTH == fitter_rule.CLEAR_BREADTH


def spread(names) -> dict[str, list[float]]:
    return {name: [100.0 + 3 * n, 50.0 + 20 * n] for n, name in enumerate(names)}


@pytest.mark.parametrize(
    "points",
    [
        spread(LIMB_POINT_NAMES),
        spread(LIMB_POINT_NAMES[:6]),
        spread(LIMB_POINT_NAMES[:5]),
        spread(LIMB_POINT_NAMES[2:6] + LIMB_POINT_NAMES[7:]),
        spread(LIMB_POINT_NAMES[2:6] + LIMB_POINT_NAMES[8:]),
        spread(POINT_NAMES[:5]),
        spread(LIMB_POINT_NAMES) | {"nose": [700.0, 10.0]},
        {key: [50.0, 60.0] for key in LIMB_POINT_NAMES},
        {},
    ],
)
def test_both_rules_accept_and_refuse_the_same_by_the_same_code(points):
    found: list[str | None] = []
    try:
        checked_points(
            {name: (x, y) for name, (x, y) in points.items()},
            PointsFormat.NAMED,
            width=640,
            height=480,
        )
        found.append(None)
    except RefusedError as error:
        found.append(error.problem.code)
    try:
        fitter_rule.check_clicks(
            {name: Click(x=x, y=y) for name, (x, y) in points.items()}, width=640, height=480
        )
        found.append(None)
    except InvalidInputError as error:
        found.append(error.code)
    assert found[0] == found[1]
