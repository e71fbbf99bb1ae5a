"""What is wrong with a picture of a scan is told by the place of its view, and nothing is kept."""

import json
import os
from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.integration.service.fake_pipeline import scripted_image
from tests.integration.service.harness import POINTS, Machine, Service, running_service
from tests.integration.service.scanning import (
    FRONT,
    SCAN,
    SIDE,
    files_of,
    post_scan,
    scanned,
    submit_scan,
)
from tests.integration.service.test_bad_input import checked
from tests.integration.service.test_images import blobs_below, uploaded

WITHOUT_DETECTOR = Path(__file__).parent / "without_detector"
OTHER = {"view": "other", "points": POINTS}
PICTURE = scripted_image()
UNKNOWN_IMAGE = "0" * 64


def kept(service: Service) -> tuple[list[Path], list[str]]:
    """The files in a service's store, and the ids of the newest scans in its list."""
    scans = service.client.get("/v1/scans").raise_for_status().json()["scans"]
    return blobs_below(service.machine.data_dir), [scan["id"] for scan in scans]


@pytest.fixture
def nothing_is_kept(without_worker: Service) -> Iterator[Service]:
    """A service in whose store and list of scans a refused request leaves nothing."""
    before = kept(without_worker)
    yield without_worker
    assert kept(without_worker) == before


@pytest.mark.parametrize(
    ("views", "field", "code"),
    [
        ([FRONT], "views", "views-count"),
        ([], "views", "views-count"),
        ([FRONT, SIDE, OTHER, OTHER, OTHER, OTHER, OTHER], "views", "views-count"),
        ([FRONT, FRONT], "views.1.view", "repeated-view"),
        ([SIDE, OTHER, FRONT, FRONT], "views.3.view", "repeated-view"),
        (
            [FRONT | {"view": "back"}, SIDE, OTHER | {"view": "back"}],
            "views.2.view",
            "repeated-view",
        ),
        ([FRONT, {"view": "above", "points": POINTS}], "views.1.view", "unknown-value"),
        ([FRONT, {"points": POINTS}], "views.1.view", "missing"),
        ([FRONT, SIDE | {"height_m": 1.7}], "views.1.height_m", "unknown-field"),
        ([FRONT, SIDE | {"points": {"nose": [1.0, 1.0]}}], "views.1.points", "too-few-points"),
        (
            [FRONT, SIDE | {"points": POINTS | {"nose": [700.0, 10.0]}}],
            "views.1.points.nose",
            "point-outside-image",
        ),
        (
            [FRONT, SIDE | {"focal_length_px": 900.0, "focal_length_35mm": 26.0}],
            "views.1.focal_length_35mm",
            "two-focal-lengths",
        ),
    ],
)
def test_views_that_make_no_scan_are_refused_by_name(nothing_is_kept, views, field, code):
    request = SCAN | {"views": views}
    answer = post_scan(nothing_is_kept, request=request, images=[PICTURE] * max(1, len(views)))
    problem = checked(answer, 422)
    assert (problem.field, problem.code) == (field, code)


@pytest.mark.parametrize(
    ("image", "status", "code"),
    [
        (b"not an image", 415, "not-an-image"),
        (b"", 422, "empty-upload"),
        (PICTURE[:20], 422, "image-damaged"),
        (scripted_image(width=10_000, height=10_000), 422, "image-too-large"),
    ],
)
def test_a_bad_second_picture_is_refused_and_the_first_not_kept(
    nothing_is_kept, image, status, code
):
    problem = checked(post_scan(nothing_is_kept, images=[PICTURE, image]), status)
    assert (problem.field, problem.code) == ("views.1.image", code)
    assert problem.detail.startswith("views.1.image: ")


def test_a_mask_of_another_size_is_refused_by_its_view(nothing_is_kept):
    smaller = scripted_image(width=64, height=48)
    problem = checked(post_scan(nothing_is_kept, masks={1: smaller}), 422)
    assert (problem.field, problem.code) == ("views.1.mask", "mask-size-mismatch")


@pytest.mark.parametrize(
    ("change", "field", "code"),
    [
        ({"image_1": None}, "image_1", "missing"),
        ({"image_2": PICTURE}, "image_2", "unknown-field"),
        ({"image": PICTURE}, "image", "unknown-field"),
        ({"mask_2": PICTURE}, "mask_2", "unknown-field"),
    ],
)
def test_every_view_has_its_picture_and_there_are_no_others(nothing_is_kept, change, field, code):
    parts = {"image_0": PICTURE, "image_1": PICTURE} | change
    files = {name: (name, each, "image/png") for name, each in parts.items() if each is not None}
    answer = nothing_is_kept.client.post(
        "/v1/scans", files=files, data={"request": json.dumps(SCAN)}
    )
    problem = checked(answer, 422)
    assert (problem.field, problem.code) == (field, code)


def test_a_picture_sent_twice_and_a_form_of_many_parts_are_refused(nothing_is_kept):
    service = nothing_is_kept
    twice = [*files_of([PICTURE, PICTURE]).items(), *files_of([PICTURE]).items()]
    answer = service.client.post("/v1/scans", files=twice, data={"request": json.dumps(SCAN)})
    assert checked(answer, 422).code == "repeated-field"
    many = files_of([PICTURE] * 40)
    answer = service.client.post("/v1/scans", files=many, data={"request": json.dumps(SCAN)})
    assert checked(answer, 400).code == "malformed-request"


def test_a_view_whose_uploaded_picture_is_not_there_is_refused(without_worker: Service):
    service = without_worker
    known = uploaded(service, PICTURE).id
    before = kept(service)
    for field, ids in (
        ("image_id", {"image_id": UNKNOWN_IMAGE}),
        ("mask_id", {"image_id": known, "mask_id": UNKNOWN_IMAGE}),
    ):
        views = [FRONT | {"image_id": known}, SIDE | ids]
        answer = service.client.post("/v1/scans", json=SCAN | {"views": views})
        problem = checked(answer, 422)
        assert (problem.field, problem.code) == (f"views.1.{field}", "unknown-image")
    views = [FRONT | {"image_id": known}, SIDE]
    problem = checked(service.client.post("/v1/scans", json=SCAN | {"views": views}), 422)
    assert (problem.field, problem.code) == ("views.1.image_id", "missing")
    assert kept(service) == before
    service.client.delete(f"/v1/images/{known}")


def test_what_is_said_of_the_person_is_said_once_and_refused_as_in_fits(nothing_is_kept):
    for change, field, code in (
        ({"height_m": 180}, "height_m", "out-of-range"),
        ({"measurements": {"stature": 180}}, "height_m", "two-heights"),
        ({"gender": "other"}, "gender", "unknown-value"),
        ({"optimizer": "newton"}, "optimizer", "unknown-value"),
    ):
        problem = checked(post_scan(nothing_is_kept, request=SCAN | change), 422)
        assert (problem.field, problem.code) == (field, code)


def test_pictures_of_other_sizes_and_orientations_are_taken(service: Service):
    upright = scripted_image(width=480, height=640)
    points = {name: [0.75 * x, y] for name, (x, y) in POINTS.items()}
    request = SCAN | {"views": [FRONT, SIDE | {"points": points}]}
    scanned(service, request=request, images=[PICTURE, upright])


def test_a_second_picture_that_cannot_be_decoded_fails_the_scan_by_its_name(service: Service):
    path = submit_scan(service, {}, {"unusable": True})
    job = service.ended(path)
    assert (job["state"], job["problem"]["code"]) == ("failed", "image-truncated")
    assert job["problem"]["field"] == "views.1.image"
    assert job["links"]["artifacts"] == {}
    assert service.client.get(f"{path}/result").status_code == 409
    assert service.client.post(f"{path}/derivations", json={"kind": "pose"}).status_code == 409


def test_pictures_that_together_are_larger_than_an_upload_are_refused(tmp_path: Path):
    machine = Machine(tmp_path, settings={"max_upload_bytes": 3_000_000})
    with running_service(machine, api_only=True) as service:
        large = scripted_image({"n": "x" * 2_600_000})
        checked(post_scan(service, images=[large, large]), 413)
        assert blobs_below(tmp_path) == []


def test_a_view_without_points_is_refused_where_none_can_be_proposed(tmp_path: Path, monkeypatch):
    monkeypatch.setenv("PYTHONPATH", str(WITHOUT_DETECTOR), prepend=os.pathsep)
    with running_service(Machine(tmp_path), api_only=True) as service:
        for change, field in (
            ({"view": "side"}, "views.1.points"),
            ({"view": "side", "points": "auto"}, "views.1.points"),
            (SIDE | {"complete_points": True}, "views.1.complete_points"),
        ):
            refused = checked(post_scan(service, request=SCAN | {"views": [FRONT, change]}), 422)
            assert (refused.field, refused.code) == (field, "detector-not-installed")
        assert blobs_below(tmp_path) == []
