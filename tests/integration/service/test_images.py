"""Uploaded pictures: kept once, named by their content, a tenant's own, gone when erased."""

import hashlib
import json
from pathlib import Path

import pytest

from api_schemas.picture import UploadedImage
from service.jobs.database import open_database, prepare_database
from service.jobs.engine import JobEngine
from service.jobs.images import NewImage
from service.jobs.storage_identity import SCOPE as STORAGE_SCOPE
from service.settings import Settings
from tests.integration.service.fake_pipeline import scripted_image
from tests.integration.service.harness import (
    REQUEST,
    Machine,
    Service,
    eventually,
    running_service,
    said_of_view,
)
from tests.integration.service.test_bad_input import checked
from tests.integration.service.test_formats import wait_for_estimator


def upload(service: Service, content: bytes):
    return service.client.post("/v1/images", files={"image": ("p.png", content, "image/png")})


def uploaded(service: Service, content: bytes) -> UploadedImage:
    answer = upload(service, content)
    assert answer.status_code in (200, 201), answer.text
    return UploadedImage.model_validate_json(answer.content)


def blobs_below(folder: Path) -> list[Path]:
    files = [path for path in (folder / "blobs").rglob("*") if path.is_file()]
    return sorted(path for path in files if path.parent.name != STORAGE_SCOPE)


def test_an_upload_is_named_by_its_content_and_found_again(service: Service):
    content = scripted_image({"n": 1}, width=300, height=200)
    answer = upload(service, content)
    image = UploadedImage.model_validate_json(answer.content)
    assert answer.status_code == 201
    assert answer.headers["Location"] == f"/v1/images/{image.id}"
    assert image.id == hashlib.sha256(content).hexdigest()
    assert (image.width, image.height, image.size) == (300, 200, len(content))
    assert (image.media_type, image.focal_length_35mm) == ("image/png", None)
    assert image.expires_at is not None
    assert image.expires_at > image.created_at
    found = service.client.get(answer.headers["Location"])
    assert UploadedImage.model_validate_json(found.content) == image
    picture = service.client.get(f"{answer.headers['Location']}/picture")
    assert (picture.content, picture.headers["Vary"]) == (content, "Accept")
    wait_for_estimator(service)
    jpeg = service.client.get(str(picture.url), headers={"Accept": "image/jpeg"})
    assert jpeg.headers["content-type"] == "image/jpeg"
    assert found.headers["Cache-Control"] == picture.headers["Cache-Control"] == "no-store"


def test_the_same_picture_is_kept_once_and_its_time_begins_anew(without_worker: Service):
    service, folder = without_worker, without_worker.machine.data_dir
    content = scripted_image({"n": 2})
    before = blobs_below(folder)
    first = upload(service, content)
    stored = blobs_below(folder)
    assert len(stored) == len(before) + 1
    second = upload(service, content)
    assert (first.status_code, second.status_code) == (201, 200)
    assert blobs_below(folder) == stored
    assert second.json()["created_at"] == first.json()["created_at"]
    assert second.json()["expires_at"] > first.json()["expires_at"]


@pytest.mark.parametrize(
    ("content", "status", "code"),
    [(b"not an image", 415, "not-an-image"), (b"", 422, "empty-upload")],
)
def test_a_bad_picture_is_refused_by_its_header(service: Service, content, status, code):
    problem = checked(upload(service, content), status)
    assert (problem.field, problem.code) == ("image", code)


def test_an_upload_has_one_part(service: Service):
    picture = ("p.png", scripted_image(), "image/png")
    answer = service.client.post("/v1/images", files=[("photo", picture), ("image", picture)])
    assert [(each.field, each.code) for each in checked(answer, 422).errors] == [
        ("photo", "unknown-field")
    ]
    missing = checked(service.client.post("/v1/images", files={"mask": picture}), 422)
    assert ("image", "missing") in {(each.field, each.code) for each in missing.errors}
    checked(service.client.post("/v1/images", content=b"raw"), 415)


def test_more_bytes_of_pictures_than_a_tenant_may_have_are_refused(tmp_path: Path):
    machine = Machine(tmp_path, settings={"max_image_bytes_per_tenant": 1_000})
    with running_service(machine, api_only=True) as service:
        uploaded(service, scripted_image({"filling": "x" * 500}))
        problem = checked(upload(service, scripted_image({"filling": "y" * 500})), 507)
        assert problem.code == "quota-exceeded"
        assert "at most 1000 may be" in problem.detail
        uploaded(service, scripted_image())


def test_an_erased_picture_is_gone_with_its_file(without_worker: Service):
    service, folder = without_worker, without_worker.machine.data_dir
    before = blobs_below(folder)
    image = uploaded(service, scripted_image({"n": 3}))
    assert len(blobs_below(folder)) == len(before) + 1
    path = f"/v1/images/{image.id}"
    assert service.client.delete(path).status_code == 204
    assert blobs_below(folder) == before
    checked(service.client.get(path), 404)
    checked(service.client.delete(path), 404)


def test_a_picture_expires_by_itself(tmp_path: Path):
    machine = Machine(tmp_path, settings={"retention_hours": 1e-5, "sweep_interval_s": 0.1})
    with running_service(machine, api_only=True) as service:
        image = uploaded(service, scripted_image({"n": 4}))
        eventually(
            lambda: service.client.get(f"/v1/images/{image.id}").status_code == 404, what="expired"
        )
        eventually(lambda: not blobs_below(tmp_path), what="its file is erased")


def test_ids_that_are_none_and_unknown_ones_are_told_apart(service: Service):
    assert checked(service.client.get("/v1/images/nonsense"), 422).field == "image_id"
    checked(service.client.get(f"/v1/images/{'0' * 64}"), 404)


def test_a_fit_is_made_of_an_uploaded_picture_and_outlives_it(service: Service):
    script = {"seconds": 0.2}
    image = uploaded(service, scripted_image(script))
    answer = service.client.post("/v1/fits", json=REQUEST | said_of_view(image_id=image.id))
    assert answer.status_code == 202, answer.text
    assert service.client.delete(f"/v1/images/{image.id}").status_code == 204
    job = service.ended(answer.headers["Location"])
    assert job["state"] == "succeeded"
    overlay = service.client.get(job["links"]["files"]["views/0/overlay.png"])
    assert overlay.content == scripted_image(script)


def test_a_mask_may_be_uploaded_too_and_has_the_picture_s_size(service: Service):
    image = uploaded(service, scripted_image())
    mask = uploaded(service, scripted_image({"n": 5}))
    small = uploaded(service, scripted_image(width=10))
    masked, wrong = (
        service.client.post(
            "/v1/fits", json=REQUEST | said_of_view(image_id=image.id, mask_id=each.id)
        )
        for each in (mask, small)
    )
    assert masked.status_code == 202
    refused = checked(wrong, 422)
    assert (refused.field, refused.code) == ("views.0.mask", "mask-size-mismatch")
    files = service.ended(masked.headers["Location"])["links"]["files"]
    assert service.client.get(files["views/0/mask"]).content == scripted_image({"n": 5})


@pytest.mark.parametrize(
    ("changes", "field", "code"),
    [
        ({"image_id": "0" * 64}, "image_id", "unknown-image"),
        ({}, "image_id", "missing"),
    ],
)
def test_a_fit_of_no_such_picture_names_the_field(service: Service, changes, field, code):
    problem = checked(service.client.post("/v1/fits", json=REQUEST | said_of_view(**changes)), 422)
    assert (problem.field, problem.code) == (f"views.0.{field}", code)


def test_an_idempotency_key_holds_for_fits_of_uploaded_pictures(service: Service):
    image = uploaded(service, scripted_image({"n": 6}))
    headers = {"Idempotency-Key": "fit-of-an-upload"}
    request = REQUEST | said_of_view(image_id=image.id)
    first, again = (
        service.client.post("/v1/fits", json=request, headers=headers) for _ in range(2)
    )
    assert first.headers["Location"] == again.headers["Location"]
    other = service.client.post(
        "/v1/fits", content=json.dumps(request | {"height_m": 1.7}), headers=headers | JSON
    )
    assert checked(other, 422).type == "/problems/idempotency-key-reused"


JSON = {"Content-Type": "application/json"}


def engine_of(machine: Machine) -> JobEngine:
    url = machine.database_url or f"sqlite:///{machine.data_dir / 'maquette.sqlite'}"
    prepare_database(url)
    return JobEngine(
        open_database(url),
        blobs=None,  # pyright: ignore[reportArgumentType]
        settings=Settings(max_image_bytes_per_tenant=10_000),
    )


def new_image(scope: str) -> NewImage:
    return NewImage(
        id="a" * 64,
        scope=scope,
        media_type="image/png",
        width=3,
        height=2,
        size=10,
        focal_length_35mm=28.0,
    )


def test_a_tenant_s_pictures_are_its_own(machine: Machine):
    engine = engine_of(machine)
    try:
        ours, theirs = engine.images_of("ours"), engine.images_of("theirs")
        ours.reserve("one", size=1)
        kept = ours.keep(new_image("one"))
        assert kept is not None
        assert kept.scope == "one"
        assert theirs.find("a" * 64) is None
        assert theirs.renew("a" * 64) is None
        assert theirs.erase("a" * 64) == []
        theirs.reserve("two", size=1)
        also = theirs.keep(new_image("two"))
        assert also is not None
        assert also.scope == "two"
        assert ours.erase("a" * 64) == ["one"]
        assert theirs.find("a" * 64) == also
    finally:
        engine.close()


def test_a_picture_stored_twice_at_once_is_kept_once_and_a_lost_one_not_at_all(machine: Machine):
    engine = engine_of(machine)
    try:
        images = engine.images_of("ours")
        images.reserve("one", size=1)
        images.reserve("two", size=1)
        first, second = images.keep(new_image("one")), images.keep(new_image("two"))
        assert first is not None
        assert second is not None
        assert second.scope == "one"
        assert engine.images_of("others").keep(new_image("never reserved")) is None
    finally:
        engine.close()
