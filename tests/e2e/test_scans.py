"""Two real pictures of one person, over HTTP: one body, which stands in both of them."""

import io
import json

import httpx
import pytest
from PIL import ExifTags, Image

from api_schemas.derivation_kinds.texture import TextureResult
from api_schemas.scans import ScanResult
from fitter.person.fitted_person import FittedPerson
from service.demo_data.sample import load_scan_sample
from tests.e2e.service import ended_job

TURN_CLOCKWISE = 6
"""The orientation of a picture that is to be turned by a quarter to the right."""

SMALLER = 3
"""Times, each side of the sample: a scan of this passes through the same code in less time."""


def smaller_sample() -> tuple[dict[str, tuple[str, bytes, str]], dict]:
    """The sample's pictures as parts of a form, and its request, reduced."""
    sample = load_scan_sample()
    parts = {}
    for number, image in enumerate(sample.images):
        stream = io.BytesIO()
        with Image.open(io.BytesIO(image)) as picture:
            picture.reduce(SMALLER).save(stream, "JPEG", exif=picture.getexif())
        parts[f"image_{number}"] = ("picture.jpg", stream.getvalue(), "image/jpeg")
    request = json.loads(sample.request)
    for view in request["views"]:
        view["points"] = {
            name: [x / SMALLER, y / SMALLER, seen] for name, (x, y, seen) in view["points"].items()
        }
    return parts, request


def test_a_person_is_measured_from_the_front_and_from_the_side(service: httpx.Client):
    client = service
    parts, request = smaller_sample()
    answer = client.post(
        "/v1/scans", files=parts, data={"request": json.dumps(request | {"weight_kg": 54.8})}
    )
    job = ended_job(client, answer)
    assert job["state"] == "succeeded", job
    files = job["links"]["artifacts"]
    result = ScanResult.model_validate_json(client.get(job["links"]["result"]).content)
    assert result.verdict == "plausible"
    assert [each.view for each in result.views] == ["front", "side"]
    for view in result.views:
        assert view.body.shape == pytest.approx(result.shape)
        assert view.silhouette_overlap > 0.8
        assert client.get(files[f"body_posed_{view.number}.glb"]).content[:4] == b"glTF"
        picture = Image.open(io.BytesIO(client.get(files[f"overlay_{view.number}.png"]).content))
        assert picture.size == (view.image_camera.width, view.image_camera.height)
    given = {each.name: each.value for each in result.measurements if each.given}
    assert given == pytest.approx({"stature": 155.5, "weight": 54.8}, abs=0.01)
    assert all(
        each.standard_error is not None and each.standard_error > 0.0
        for each in result.measurements
        if not each.given
    )
    person = FittedPerson.from_bytes(client.get(files["person.npz"]).content)
    assert person.body.shape == pytest.approx(result.shape, abs=1e-6)
    assert person.shape_covariance is not None
    tapes = client.get(files["tapes.json"]).json()
    assert {each.name for each in result.measurements} - {"weight"} <= set(tapes["lines"])

    made = client.post(f"{job['links']['derivations']}", json={"kind": "texture", "size": 1024})
    texture = ended_job(client, made)
    assert texture["state"] == "succeeded", texture
    document = client.get(texture["links"]["result"]).content
    # At a third of the sample's size the outline's margin takes half of what is seen (0.31).
    assert TextureResult.model_validate_json(document).seen_share > 0.15
    composition = {"kind": "body_composition", "age_years": 70}
    share = ended_job(client, client.post(job["links"]["derivations"], json=composition))
    assert share["state"] == "succeeded", share
    assert client.delete(job["links"]["self"]).status_code == 204
    assert client.get(texture["links"]["self"]).status_code == 404


def test_a_view_in_which_nobody_is_found_fails_the_scan_by_its_name(service: httpx.Client):
    parts, request = smaller_sample()
    stream = io.BytesIO()
    Image.new("RGB", (240, 320), (120, 130, 140)).save(stream, "JPEG")
    parts["image_1"] = ("wall.jpg", stream.getvalue(), "image/jpeg")
    request["views"][1] = {"view": "side"}
    answer = service.post("/v1/scans", files=parts, data={"request": json.dumps(request)})
    job = ended_job(service, answer)
    assert (job["state"], job["problem"]["field"]) == ("failed", "views.1.points")
    assert job["links"]["artifacts"] == {}


def test_a_second_picture_that_lies_on_its_side_is_measured_upright(service: httpx.Client):
    """As a phone stores it: rows run down the person, and EXIF says how to turn them."""
    parts, request = smaller_sample()
    stream = io.BytesIO()
    with Image.open(io.BytesIO(parts["image_1"][1])) as picture:
        upright, exif = picture.size, picture.getexif()
        exif[ExifTags.Base.Orientation] = TURN_CLOCKWISE
        picture.transpose(Image.Transpose.ROTATE_90).save(stream, "JPEG", exif=exif, quality=95)
    parts["image_1"] = ("lying.jpg", stream.getvalue(), "image/jpeg")
    answer = service.post("/v1/scans", files=parts, data={"request": json.dumps(request)})
    job = ended_job(service, answer)
    assert job["state"] == "succeeded", job
    result = ScanResult.model_validate_json(service.get(job["links"]["result"]).content)
    camera = result.views[1].image_camera
    assert (camera.width, camera.height) == upright
    assert upright[0] < upright[1]
    assert result.views[1].verdict == "plausible"
    assert result.views[1].silhouette_overlap > 0.8
    overlay = service.get(job["links"]["artifacts"]["overlay_1.png"]).content
    assert Image.open(io.BytesIO(overlay)).size == upright


def test_what_nobody_can_be_is_told_as_in_fits(service: httpx.Client):
    parts, request = smaller_sample()
    asked = request | {"weight_kg": 20.0, "measurements": {"waist_girth_navel": 140}}
    answer = service.post("/v1/scans", files=parts, data={"request": json.dumps(asked)})
    assert answer.status_code == 422
    assert not answer.json()["field"].startswith("views")
    assert service.get("/v1/scans?state=queued").json()["scans"] == []


def test_a_second_picture_that_ends_early_fails_the_scan_by_its_name(service: httpx.Client):
    parts, request = smaller_sample()
    name, content, kind = parts["image_1"]
    parts["image_1"] = (name, content[: len(content) // 2], kind)
    answer = service.post("/v1/scans", files=parts, data={"request": json.dumps(request)})
    problem = answer.json() if answer.status_code == 422 else ended_job(service, answer)["problem"]
    assert problem["field"] == "views.1.image"
