"""Points are refused before anything is queued, by the fitter's own rules and all at once."""

import pytest

from api_schemas.points import PointsFormat
from fitter.vocabulary.points import LIMB_POINT_NAMES, POINT_NAMES
from service.submissions.point_rules import checked_points
from service.submissions.refusal import RefusedError


def spread(names) -> dict[str, tuple[float, float]]:
    return {name: (100.0 + 3 * n, 50.0 + 20 * n) for n, name in enumerate(names)}


def checked(points):
    return checked_points(points, PointsFormat.NAMED, width=640, height=480)


@pytest.mark.parametrize(
    "points",
    [
        spread(LIMB_POINT_NAMES),
        spread(LIMB_POINT_NAMES[:4]),
        spread(LIMB_POINT_NAMES[:1] + LIMB_POINT_NAMES[3:7]) | spread(LIMB_POINT_NAMES[8:10]),
    ],
)
def test_enough_points_are_taken(points):
    assert {name: (point.x, point.y) for name, point in checked(points).items()} == points


@pytest.mark.parametrize(
    ("points", "code"),
    [
        (spread(LIMB_POINT_NAMES[:3]), "too-few-points"),
        (spread(LIMB_POINT_NAMES[2:6] + LIMB_POINT_NAMES[7:]), "too-few-points"),
        (spread(LIMB_POINT_NAMES[2:6] + LIMB_POINT_NAMES[8:]), "too-few-points"),
        (spread(POINT_NAMES[:5]), "too-few-points"),
        ({}, "too-few-points"),
        (dict.fromkeys(LIMB_POINT_NAMES, (50.0, 60.0)), "points-too-close"),
        (spread(LIMB_POINT_NAMES) | {"nose": (700.0, 10.0)}, "point-outside-image"),
    ],
)
def test_points_a_fit_cannot_start_from_are_refused(points, code):
    with pytest.raises(RefusedError) as refused:
        checked(points)
    assert refused.value.problem.code == code


def test_every_point_outside_the_picture_is_named():
    beyond = {"nose": (700.0, 10.0), "left_ear": (10.0, 500.0)}
    with pytest.raises(RefusedError) as refused:
        checked(spread(LIMB_POINT_NAMES) | beyond)
    fields = {each.field for each in refused.value.problem.errors or ()}
    assert fields == {"points.nose", "points.left_ear"}
