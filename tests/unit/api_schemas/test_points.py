import json

import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydantic import TypeAdapter, ValidationError
from pydantic_core import PydanticCustomError

from api_schemas.points import (
    BLAZEPOSE33_INDEX,
    OPENPOSE_BODY25_INDEX,
    POINT_COUNTS,
    Point,
    Points,
    PointsFormat,
    PointSource,
    named_points,
)
from fitter.vocabulary.points import COCO_POINT_NAMES

PARSER = TypeAdapter(Points)


def named(value: object, layout: PointsFormat, *, width: int = 200, height: int = 100):
    return named_points(PARSER.validate_json(json.dumps(value)), layout, width=width, height=height)


def test_the_three_ways_to_write_a_point_mean_the_same():
    written = {"nose": [3, 4], "left_eye": [3, 4, 2], "right_eye": {"x": 3, "y": 4}}
    assert set(named(written, PointsFormat.NAMED).values()) == {Point(x=3.0, y=4.0)}


@pytest.mark.parametrize("layout", POINT_COUNTS)
def test_rows_and_a_flat_list_of_a_detector_mean_the_same(layout):
    rows = [[0.01 * i, 0.02 * i, 1.0] for i in range(POINT_COUNTS[layout])]
    flat = [number for row in rows for number in row]
    assert named(rows, layout) == named(flat, layout)


def test_coco_keeps_order_and_visibility():
    rows = [[float(i), 50.0, i % 3] for i in range(17)]
    points = named(rows, PointsFormat.COCO17)
    assert points == {
        name: Point(x=float(i), y=50.0, visibility=i % 3)
        for i, name in enumerate(COCO_POINT_NAMES)
        if i % 3
    }


def test_openpose_leaves_out_what_it_did_not_see():
    rows = [[float(i), 1.0, 0.0 if i == 2 else 0.5] for i in range(25)]
    points = named(rows, PointsFormat.OPENPOSE_BODY25)
    assert "right_shoulder" not in points  # BODY_25 has it at 2
    assert points["left_shoulder"].x == 5.0
    assert points["left_wrist"].x == 7.0
    assert points["left_toe"].x == 19.0
    assert "neck" not in points


def test_blazepose_is_scaled_to_pixels_and_loses_points_outside():
    landmarks = [[0.5, 0.25, 0.9] for _ in range(33)]
    landmarks[27][2] = 0.2
    landmarks[28][1] = 1.2
    points = named(landmarks, PointsFormat.BLAZEPOSE33)
    assert points["left_knee"] == Point(
        x=100.0, y=25.0, visibility=2, source=PointSource.PROPOSAL, confidence=0.9
    )
    assert points["left_ankle"].visibility == 1
    assert "right_ankle" not in points


def test_blazepose_in_pixels_is_told_that_shares_are_expected():
    landmarks = [[120.0 + i, 300.0, 0.9] for i in range(33)]
    with pytest.raises(PydanticCustomError, match="shares of the picture") as caught:
        named(landmarks, PointsFormat.BLAZEPOSE33)
    assert caught.value.type == "points-in-pixels"
    assert "width" in (caught.value.context or {})["remedy"]


@pytest.mark.parametrize("layout", POINT_COUNTS)
@pytest.mark.parametrize("confidence", [0.3, 0.8])
def test_a_detectors_confidence_is_kept_in_every_format(layout, confidence):
    rows = [[0.4, 0.5, confidence] for _ in range(POINT_COUNTS[layout])]
    for point in named(rows, layout).values():
        assert (point.source, point.confidence) == (PointSource.PROPOSAL, confidence)
        assert point.visibility == (2 if confidence > 0.5 else 1)


def test_a_score_above_one_is_one_and_a_score_of_zero_is_no_point():
    rows = [[5.0, 5.0, 1.04] for _ in range(25)]
    assert named(rows, PointsFormat.OPENPOSE_BODY25)["nose"].confidence == 1.0
    rows = [[5.0, 5.0, 0.0 if i == 0 else 0.7] for i in range(17)]
    assert "nose" not in named(rows, PointsFormat.COCO17)


def test_coco_without_a_score_in_it_is_visibility():
    rows = [[5.0, 5.0, float(i % 2)] for i in range(17)]
    points = named(rows, PointsFormat.COCO17)
    assert {(point.source, point.visibility) for point in points.values()} == {
        (PointSource.CLICK, 1)
    }


@pytest.mark.parametrize("table", [OPENPOSE_BODY25_INDEX, BLAZEPOSE33_INDEX])
def test_detector_tables_take_every_index_once_and_swap_no_sides(table):
    assert len(set(table.values())) == len(table)
    assert set(COCO_POINT_NAMES) <= set(table)


def test_blazepose_has_the_left_side_at_odd_indices_below_the_face():
    limbs = [name for name in BLAZEPOSE33_INDEX if BLAZEPOSE33_INDEX[name] >= 11]
    assert all((BLAZEPOSE33_INDEX[name] % 2 == 1) == name.startswith("left") for name in limbs)


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
    assert named(points, PointsFormat.NAMED) == expected
