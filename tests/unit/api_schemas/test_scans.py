"""What makes a scan on the wire, and what is asked of each of its views."""

import json
from typing import Any

import pytest
from pydantic import ValidationError

from api_schemas.points import AUTO
from api_schemas.requests import FitRequest
from api_schemas.scans import ScanOptions, ScanRequest
from fitter.vocabulary.choices import Clothing, OptimizerKind, ViewKind
from service.submissions.validation import field_problems

POINTS = {"nose": [1.0, 2.0]}
FRONT: dict[str, Any] = {"view": "front", "points": POINTS}
SIDE: dict[str, Any] = {"view": "side", "points": POINTS}


def request(*views: dict[str, Any], **changes: object) -> ScanRequest:
    values = {"gender": "female", "height_m": 1.7, "views": views} | changes
    return ScanRequest.model_validate_json(json.dumps(values))


def problem(*views: dict[str, Any]) -> tuple[str, str]:
    with pytest.raises(ValidationError) as refused:
        request(*views)
    (error,) = field_problems(refused.value.errors())
    return error.field, error.code


def test_a_scan_has_two_to_six_views():
    other = {"view": "other"}
    for count in (0, 1, 7):
        assert problem(*[other] * count) == ("views", "views-count")
    for count in range(2, 7):
        assert len(request(*[other] * count).views) == count


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


def test_points_that_are_left_out_are_proposed():
    view = request(FRONT, {"view": "side"}).views[1]
    assert view.points == AUTO
    options = view.options({})
    assert (options.points, options.complete_points) == ({}, True)


def test_of_every_view_is_kept_what_was_said_of_it_and_of_the_person_once():
    asked = request(
        FRONT,
        SIDE | {"clothing": "loose", "focal_length_35mm": 26.0},
        weight_kg=64.5,
        measurements={"hip_girth": {"value": 98.0, "standard_error": 1.5}},
        cues="SE",
        force=True,
    )
    options = asked.understood([{} for _ in asked.views])
    kept = ScanOptions.model_validate_json(options.model_dump_json())
    assert kept == options
    first, second = kept.pictures
    assert (first.clothing, first.focal_length_35mm) == ("auto", None)
    assert (second.clothing, second.focal_length_35mm) == ("loose", 26.0)
    assert (kept.weight_kg, kept.cues, kept.force) == (64.5, "SE", True)


@pytest.mark.parametrize("name", ["view", "optimizer"])
def test_a_request_that_version_1_0_knows_is_stored_in_its_words(name):
    """Workers of that version run it too while they are replaced; they refuse unknown fields."""
    scan = request(FRONT, SIDE).understood([{}, {}])
    fit = FitRequest.model_validate_json(json.dumps({"gender": "female", "points": POINTS}))
    stored = {"view": fit.understood([{}]), "optimizer": scan}[name]
    assert name not in json.loads(stored.model_dump_json())
    said = stored.model_copy(update={"view": ViewKind.SIDE, "optimizer": OptimizerKind.SIMPLEX})
    assert name in json.loads(said.model_dump_json())


def test_clothing_of_which_nothing_is_said_is_stored_as_version_1_0_does_not_know_it():
    fit = FitRequest.model_validate_json(json.dumps({"gender": "female", "points": POINTS}))
    stored = fit.understood([{}])
    words = json.loads(stored.model_dump_json())
    assert "clothing" not in words
    assert "clothing_by_region" not in words
    assert (
        json.loads(stored.model_copy(update={"clothing": Clothing.LOOSE}).model_dump_json())[
            "clothing"
        ]
        == "loose"
    )
