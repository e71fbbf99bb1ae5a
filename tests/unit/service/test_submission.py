import io
import json
import sys
from collections.abc import Sequence

import pytest
from PIL import Image

from api_schemas.fit import FitRequest
from api_schemas.picture import ViewRequest
from api_schemas.points import AUTO, Point
from api_schemas.questions import PointsRequest
from fitter.vocabulary.points import LIMB_POINT_NAMES, POINT_NAMES
from service.demo_data.sample import load_sample
from service.jobs.inputs import SentPicture
from service.submissions.refusal import RefusedError, parsed
from service.submissions.submission import (
    MOST_SCANS,
    CheckedSubmission,
    check_picture,
    check_submission,
)
from tests.heif_files import EIGHT_BITS
from tests.integration.service.fake_pipeline import scripted_image

POINTS = {
    "left_shoulder": [200, 100],
    "right_shoulder": [100, 100],
    "left_hip": [180, 250],
    "right_hip": [120, 250],
    "left_knee": [182, 350],
    "right_knee": [118, 350],
}
LIMBS_WITHOUT_TRUNK = {
    f"{side}_{joint}": [100 + 10 * n, 100 * n]
    for n, joint in enumerate(("elbow", "wrist", "knee"))
    for side in ("left", "right")
} | {"left_hip": [180, 250]}
FACE_AND_TRUNK = dict(list(POINTS.items())[:3]) | {
    name: [150, 40 + n] for n, name in enumerate(("nose", "left_eye", "right_eye", "chin"))
}


def check(
    request: dict[str, object] | bytes | None = None,
    *,
    image: bytes | None = None,
    mask: bytes | None = None,
    **changes: object,
) -> CheckedSubmission:
    of_view = {name: each for name, each in changes.items() if name in ViewRequest.model_fields}
    of_person = {name: each for name, each in changes.items() if name not in of_view}
    whole = {
        "gender": "male",
        "height_m": 1.8,
        **of_person,
        "views": [{"points": POINTS, **of_view}],
    }
    text = request if isinstance(request, bytes) else json.dumps(request or whole).encode()
    return check_submission(
        parsed(FitRequest, text, whole="request", called="the part 'request'"),
        [SentPicture(scripted_image() if image is None else image, mask)],
        max_pixels=1_000_000,
    )


def points_of(checked: CheckedSubmission) -> object:
    (view,) = checked.request.views
    return view.points


def refusal(*args, **kwargs) -> tuple[int, str | None, str]:
    with pytest.raises(RefusedError) as caught:
        check(*args, **kwargs)
    reason = caught.value.problem
    assert reason.remedy
    assert reason.detail
    return reason.status, reason.field, reason.code


def test_points_come_out_named_and_in_full():
    points = points_of(check())
    assert isinstance(points, dict)
    assert points["left_shoulder"] == Point(x=200.0, y=100.0, visibility=2)


def test_auto_stays_the_word_that_has_all_points_proposed():
    (view,) = check(points="auto").request.views
    assert (view.points, view.are_points_completed) == (AUTO, True)
    (clicked,) = check().request.views
    assert not clicked.are_points_completed


def test_points_to_be_completed_may_be_few_but_not_beyond_the_picture():
    knee = {"left_knee": [182, 350]}
    assert refusal(points=knee) == (422, "views.0.points", "too-few-points")
    (view,) = check(points=knee, complete_points=True).request.views
    assert set(view.points) == {"left_knee"}
    assert view.complete_points
    assert points_of(check(points={}, complete_points=True)) == {}
    outside = refusal(points={"left_knee": [182, 481]}, complete_points=True)
    assert outside == (422, "views.0.points.left_knee", "point-outside-image")
    assert refusal(points="all") == (422, "views.0.points", "unknown-value")


def test_checking_twice_changes_nothing():
    once = check().request
    again = check(once.model_dump_json().encode()).request
    assert again == once


@pytest.mark.parametrize(
    ("changes", "field", "code"),
    [
        ({"height_m": 1.19}, "height_m", "out-of-range"),
        ({"height_m": 2.31}, "height_m", "out-of-range"),
        ({"height_m": "1.8"}, "height_m", "wrong-kind"),
        ({"height_m": float("nan")}, "height_m", "not-finite"),
        ({"gender": "unknown"}, "gender", "unknown-value"),
        ({"gender": None}, "gender", "unknown-value"),
        ({"weight": 80}, "weight", "unknown-field"),
        ({"weight_kg": 0}, "weight_kg", "out-of-range"),
        ({"weight_kg": float("nan")}, "weight_kg", "not-finite"),
        ({"weight_kg": 80, "measurements": {"weight": 80}}, "weight_kg", "two-weights"),
        ({"measurements": {"stature": 180}}, "height_m", "two-heights"),
        ({"measurements": {"inseam": -80}}, "measurements.inseam", "out-of-range"),
        ({"measurements": {"inseam": "80"}}, "measurements.inseam", "wrong-kind"),
        ({"measurements": {"inseam": {"value": 80}}}, "measurements.inseam", "missing"),
        (
            {"measurements": {"inseam": {"value": 80, "standard_error": -1}}},
            "measurements.inseam.standard_error",
            "out-of-range",
        ),
        ({"points": {}}, "points", "too-few-points"),
        ({"points": dict(list(POINTS.items())[:3])}, "points", "too-few-points"),
        ({"points": LIMBS_WITHOUT_TRUNK}, "points", "too-few-points"),
        ({"points": FACE_AND_TRUNK}, "points", "too-few-points"),
        ({"points": {key: [150, 200] for key in POINTS}}, "points", "points-too-close"),
        ({"points": POINTS | {"nose": [float("nan"), 1]}}, "points.nose", "not-finite"),
        ({"points": POINTS | {"nose": [1, float("inf")]}}, "points.nose", "not-finite"),
        ({"points": POINTS | {"nose": [641, 100]}}, "points.nose", "point-outside-image"),
        ({"points": POINTS | {"nose": [100, -1]}}, "points.nose", "point-outside-image"),
        ({"points": POINTS | {"left_tail": [1, 1]}}, "points.left_tail", "unknown-value"),
        ({"points": POINTS | {"nose": [1]}}, "points.nose", "wrong-length"),
        ({"points": POINTS | {"nose": [1, 1, 2, 3]}}, "points.nose", "wrong-length"),
        ({"points": POINTS | {"nose": [1, 1, 3]}}, "points.nose", "unknown-visibility"),
        ({"points": [[1.0, 2.0, 2]]}, "points", "wrong-length"),
        ({"focal_length_px": 0}, "focal_length_px", "out-of-range"),
        (
            {"focal_length_px": 900, "focal_length_35mm": 50},
            "focal_length_35mm",
            "two-focal-lengths",
        ),
        ({"cues": "S"}, "cues", "unknown-value"),
        ({"cues": "SE", "paper": {"energies": ["shading"]}}, "paper.energies", "wrong-length"),
        ({"clothing": "baggy"}, "clothing", "unknown-value"),
        ({"clothing": {"upper": "baggy"}}, "clothing.upper", "unknown-value"),
        ({"limb_facing": {"left_forearm": "up"}}, "limb_facing.left_forearm", "unknown-value"),
        ({"limb_facing": {"tail": "away"}}, "limb_facing.tail", "unknown-value"),
    ],
)
def test_a_bad_option_is_refused_naming_field_and_code(changes, field, code):
    status, named, named_code = refusal(**changes)
    assert status == 422
    assert named is not None
    of_view = field.partition(".")[0] in ViewRequest.model_fields
    assert named.startswith(f"views.0.{field}" if of_view else field)
    assert named_code == code


def spread(names: Sequence[str]) -> dict[str, list[float]]:
    return {name: [100.0 + 3 * n, 50.0 + 20 * n] for n, name in enumerate(names)}


@pytest.mark.parametrize(
    "names",
    [
        LIMB_POINT_NAMES,
        LIMB_POINT_NAMES[:4],
        LIMB_POINT_NAMES[:1] + LIMB_POINT_NAMES[3:7] + LIMB_POINT_NAMES[8:10],
    ],
)
def test_enough_points_are_taken(names: Sequence[str]):
    points = points_of(check(points=spread(names)))
    assert {name: [at.x, at.y] for name, at in points.items()} == spread(names)


def test_every_point_outside_the_picture_is_named():
    beyond = {"nose": [700.0, 10.0], "left_ear": [10.0, 500.0]}
    with pytest.raises(RefusedError) as caught:
        check(points=spread(LIMB_POINT_NAMES) | beyond)
    fields = {each.field for each in caught.value.problem.errors}
    assert fields == {"views.0.points.nose", "views.0.points.left_ear"}


@pytest.mark.parametrize(
    ("name", "meant"),
    [
        ("height", " height_m?"),
        ("height_cm", " height_m?"),
        ("hieght", " height_m?"),
        ("wieght", " weight_kg?"),
        ("view", " views?"),
        ("colour", ""),
    ],
)
def test_an_unknown_field_is_told_by_what_it_may_have_been_meant_for(name: str, meant: str):
    said = f"Remove it, or correct its name:{meant}" if meant else "Remove it, or correct its name."
    with pytest.raises(RefusedError) as caught:
        check({"gender": "male", name: 1})
    assert [each.remedy for each in caught.value.problem.errors] == [said]


def test_a_misspelt_point_is_one_fault_that_offers_every_name():
    with pytest.raises(RefusedError) as caught:
        check(points=POINTS | {"left_sholder": [1, 1]})
    (error,) = caught.value.problem.errors
    assert error.field == "views.0.points.left_sholder"
    assert all(f"'{name}'" in error.remedy for name in POINT_NAMES)


@pytest.mark.parametrize(("cues", "energies"), [("SES", ["shading"]), ("SE", ["shading", "edges"])])
def test_the_papers_method_is_accepted_where_a_term_counts(cues: str, energies: list[str]):
    paper = check(cues=cues, paper={"energies": energies}).request.paper
    assert paper is not None
    assert list(paper.energies) == energies


def test_all_faults_are_told_at_once():
    with pytest.raises(RefusedError) as caught:
        check(height_m=3.0, gender="unknown")
    assert {error.field for error in caught.value.problem.errors} == {"height_m", "gender"}


@pytest.mark.parametrize(
    "faults",
    [
        {"points": {f"{n:04}{'x' * 200}": [1, 1] for n in range(900)}},
        {f"{n:04}{'x' * 200}": 1 for n in range(900)},
    ],
    ids=["points", "fields"],
)
def test_of_many_faults_ten_are_told_and_their_number(faults: dict[str, object]):
    with pytest.raises(RefusedError) as caught:
        parsed(PointsRequest, json.dumps(faults).encode(), whole="body", called="the body")
    told = caught.value.problem
    assert len(told.errors) == 10
    assert "890 more are at fault." in told.detail
    assert all(len(error.field) < 120 for error in told.errors)
    assert len(told.model_dump_json()) < 20_000


@pytest.mark.parametrize("points", [[[1]] * 3_001, [1] * 3_001, {f"p{n}": 1 for n in range(3_001)}])
def test_json_of_many_values_is_refused_before_each_is_looked_at(points: object):
    text = json.dumps({"points": points}).encode()
    with pytest.raises(RefusedError) as caught:
        parsed(PointsRequest, text, whole="body", called="the body")
    (error,) = caught.value.problem.errors
    assert (error.field, error.code) == ("body", "wrong-length")


def test_faults_that_belong_to_a_view_are_counted_too():
    with pytest.raises(RefusedError) as caught:
        check(points={name: [9_999, 9_999] for name in POINT_NAMES})
    told = caught.value.problem
    assert (len(told.errors), told.errors[0].field) == (10, f"views.0.points.{POINT_NAMES[0]}")
    assert f"{len(POINT_NAMES) - 10} more are at fault." in told.detail


def test_an_absent_point_does_not_count():
    points = dict(list(POINTS.items())[:4])
    points["left_hip"] = {"x": 180, "y": 250, "visibility": 0}
    assert refusal(points=points) == (422, "views.0.points", "too-few-points")


def test_a_point_on_the_very_edge_is_inside():
    points = points_of(check(points=POINTS | {"nose": [640, 480]}))
    assert "nose" in points


def test_text_that_is_not_json_is_malformed():
    assert refusal(b"gender=male") == (400, "request", "invalid-json")


@pytest.mark.parametrize("field", ["image", "mask"])
@pytest.mark.parametrize(
    ("content", "status", "code"),
    [
        (b"", 422, "empty-upload"),
        (b"plain text", 415, "not-an-image"),
        (b"\x89PNG\r\n\x1a\n", 422, "image-damaged"),
        (scripted_image(width=20_000, height=20_000), 422, "image-too-large"),
        (load_sample().image[:-2] + b"\xff\xda\0\x02" * MOST_SCANS, 422, "image-too-many-scans"),
    ],
)
def test_a_bad_picture_is_refused(field, content, status, code):
    assert refusal(**{field: content}) == (status, f"views.0.{field}", code)


@pytest.mark.parametrize(
    ("kind", "field", "is_taken"),
    [("JPEG", "image", True), ("PNG", "image", False), ("JPEG", "mask", False)],
)
def test_only_a_jpeg_may_have_more_pixels_than_are_decoded(
    monkeypatch, kind: str, field: str, is_taken: bool
):
    monkeypatch.setattr("fitter.observation.picture_files.WHOLE_PIXELS", 10_000)
    stream = io.BytesIO()
    Image.new("RGB", (200, 100)).save(stream, kind)
    if is_taken:
        assert check_picture(field, stream.getvalue(), max_pixels=20_000).width == 200
    else:
        with pytest.raises(RefusedError) as caught:
            check_picture(field, stream.getvalue(), max_pixels=20_000)
        assert caught.value.problem.code == "image-too-large"


def test_a_heic_is_accepted():
    checked = check(image=EIGHT_BITS, points=AUTO)
    assert {name: file.media_type for name, file in checked.files.items()} == {
        "views/0/image": "image/heic"
    }


def test_a_heic_is_refused_where_none_are_decoded(monkeypatch):
    monkeypatch.setitem(sys.modules, "pi_heif", None)
    assert refusal(image=EIGHT_BITS) == (415, "views.0.image", "heic-not-installed")


def test_a_mask_of_another_size_is_refused():
    mask = scripted_image(width=639)
    assert refusal(mask=mask) == (422, "views.0.mask", "mask-size-mismatch")


def test_a_mask_of_the_same_size_is_accepted():
    assert check(mask=scripted_image()).files["views/0/mask"].media_type == "image/png"


def test_there_are_as_many_views_as_pictures():
    asked = FitRequest.model_validate_json('{"gender": "male"}')
    pictures = [SentPicture(scripted_image({"n": number}), None) for number in range(2)]
    with pytest.raises(RefusedError) as caught:
        check_submission(asked, pictures, max_pixels=1_000_000)
    assert (caught.value.problem.field, caught.value.problem.code) == ("views", "views-count")
