import json

import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydantic import TypeAdapter, ValidationError

from api_schemas.points import (
    Point,
    Points,
    PointSource,
    named_points,
)
from fitter.vocabulary.points import COCO_POINT_NAMES

PARSER = TypeAdapter(Points)


def named(value: object):
    return named_points(PARSER.validate_json(json.dumps(value)))


def test_the_three_ways_to_write_a_point_mean_the_same():
    written = {"nose": [3, 4], "left_eye": [3, 4, 2], "right_eye": {"x": 3, "y": 4}}
    assert set(named(written).values()) == {Point(x=3.0, y=4.0)}


def test_coco_keeps_order_and_visibility():
    rows = [[float(i), 50.0, i % 3] for i in range(17)]
    points = named(rows)
    assert points == {
        name: Point(x=float(i), y=50.0, visibility=i % 3)
        for i, name in enumerate(COCO_POINT_NAMES)
        if i % 3
    }


@pytest.mark.parametrize("confidence", [0.3, 0.8])
def test_a_detectors_score_is_kept(confidence):
    for point in named([[0.4, 0.5, confidence]] * 17).values():
        assert (point.source, point.confidence) == (PointSource.PROPOSAL, confidence)
        assert point.visibility == (2 if confidence > 0.5 else 1)


def test_a_score_of_zero_is_no_point():
    assert "nose" not in named([[5.0, 5.0, 0.0 if i == 0 else 0.7] for i in range(17)])


@pytest.mark.parametrize("mark", [-1, 1.5, 3])
def test_rows_have_either_visibility_or_scores(mark):
    with pytest.raises(ValidationError, match="Visibility is 0"):
        named([[5.0, 5.0, mark]] * 17)


@pytest.mark.parametrize("count", [1, 16, 25])
def test_another_number_of_rows_is_refused(count):
    with pytest.raises(ValidationError, match="17"):
        named([[5.0, 5.0, 2]] * count)


def test_coco_without_a_score_in_it_is_visibility():
    rows = [[5.0, 5.0, float(i % 2)] for i in range(17)]
    points = named(rows)
    assert {(point.source, point.visibility) for point in points.values()} == {
        (PointSource.CLICK, 1)
    }


@pytest.mark.parametrize("value", [True, 3, -1, 1.5, "2", None])
def test_another_visibility_is_refused(value):
    with pytest.raises(ValidationError, match="Visibility is 0"):
        PARSER.validate_json(json.dumps({"nose": {"x": 1, "y": 1, "visibility": value}}))


def test_json_has_one_kind_of_number():
    point = PARSER.validate_json('{"nose": {"x": 1, "y": 1, "visibility": 2.0}}')
    assert point == {"nose": Point(x=1.0, y=1.0, visibility=2)}


finite = st.floats(-1e6, 1e6)


@given(st.dictionaries(st.sampled_from(COCO_POINT_NAMES), st.tuples(finite, finite)))
def test_named_points_survive_the_wire(points):
    expected = {name: Point(x=x, y=y) for name, (x, y) in points.items()}
    assert named(points) == expected
