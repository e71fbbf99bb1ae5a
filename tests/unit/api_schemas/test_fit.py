"""What makes a fit on the wire, and what is asked of each of its pictures."""

import json
from typing import Any

import pytest
from pydantic import ValidationError

from api_schemas.fit import FitRequest
from api_schemas.points import AUTO, Point
from fitter.vocabulary.choices import ViewKind
from service.submissions.refusal import field_problems

POINTS = {"nose": [1.0, 2.0]}
FRONT: dict[str, Any] = {"view": "front", "points": POINTS}
SIDE: dict[str, Any] = {"view": "side", "points": POINTS}


def request(*views: dict[str, Any], **changes: object) -> FitRequest:
    values = {"gender": "female", "height_m": 1.7, "views": views} | changes
    return FitRequest.model_validate_json(json.dumps(values))


def problem(*views: dict[str, Any]) -> tuple[str, str]:
    with pytest.raises(ValidationError) as refused:
        request(*views)
    ((error,), _) = field_problems(refused.value.errors())
    return error.field, error.code


def test_the_least_request_is_a_gender_of_one_picture_whose_points_are_proposed():
    (view,) = FitRequest.model_validate_json('{"gender": "female"}').views
    assert (view.view, view.points, view.are_points_completed) == (None, AUTO, True)


def test_a_fit_has_one_to_six_views():
    other = {"view": "other"}
    for count in (0, 7):
        assert problem(*[other] * count) == ("views", "wrong-length")
    for count in range(1, 7):
        assert len(request(*[other] * count).views) == count


def test_each_of_several_pictures_says_from_where_it_shows_the_person():
    assert problem(FRONT, {"points": POINTS}) == ("views.1.view", "missing")


@pytest.mark.parametrize("kind", list(ViewKind))
def test_people_have_one_front_and_one_back_but_two_sides(kind):
    views = ({"view": "other"}, {"view": kind}, {"view": kind})
    if kind in (ViewKind.FRONT, ViewKind.BACK):
        assert problem(*views) == ("views.2.view", "repeated-view")
    else:
        request(*views)


def test_a_fault_within_a_view_is_told_by_its_place():
    lenses = {"focal_length_px": 900.0, "focal_length_35mm": 26.0}
    assert problem(FRONT, SIDE | lenses) == ("views.1.focal_length_35mm", "two-focal-lengths")
    assert problem(FRONT, SIDE | {"clothing": "none"}) == ("views.1.clothing", "unknown-value")


def test_a_request_is_kept_with_named_points_and_without_whom_to_tell():
    webhook = {"url": "https://example.org/hooks", "secret": None}
    asked = request(FRONT, {"view": "side"}, label="A", webhook=webhook)
    kept = asked.understood([{"nose": Point(x=1.0, y=2.0)}, {}])
    assert FitRequest.model_validate_json(kept.model_dump_json()) == kept
    assert (kept.label, kept.webhook) == ("A", None)
    assert kept.views[0].points == {"nose": Point(x=1.0, y=2.0)}
    assert kept.views[1].points == AUTO
