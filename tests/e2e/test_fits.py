"""Questions and fits by the service as a user starts it: points, bodies, the paper's method."""

import base64
import io
import json
from pathlib import Path

import httpx
import numpy as np
import pytest
import trimesh
from PIL import Image

from api_schemas.results import FitResult
from service.demo_data.sample import load_sample
from tests.e2e.service import ended_job, wait_for_estimator
from tests.submissions import small_submissions

PERSON = {"gender": "male", "height_m": 1.804}


def picture(content: bytes) -> dict[str, tuple[str, bytes, str]]:
    return {"image": ("picture", content, "application/octet-stream")}


def fitted(client: httpx.Client, image: bytes, **view: object) -> dict:
    """The result of a fit of silhouette and edges, with what is said of the picture."""
    request = json.dumps(PERSON | {"cues": "SE", "views": [view]})
    answer = client.post("/v1/fits", files=picture(image), data={"request": request})
    job = ended_job(client, answer)
    assert job["state"] == "succeeded", job["problem"]
    return client.get(job["links"]["result"]).raise_for_status().json()


def assumed(result: dict) -> list[str]:
    """Names of the points that the result says were proposed."""
    (view,) = result["views"]
    said = [each["where"] for each in view["assumptions"] if each["code"] == "points-proposed"]
    return said[0] if said else []


@pytest.fixture(scope="module")
def client(service: httpx.Client) -> httpx.Client:
    wait_for_estimator(service)
    return service


def test_proposed_points_lie_near_the_clicks_and_the_mask_has_the_picture_s_size(
    client: httpx.Client,
):
    sample = load_sample()
    answer = client.post(
        "/v1/points", files=picture(sample.image), data={"request": '{"mask": true}'}
    )
    found = answer.raise_for_status().json()
    (view,) = json.loads(sample.request)["views"]
    clicked = view["points"]
    both = found["points"].keys() & clicked.keys()
    assert len(both) >= 16
    off = [
        np.hypot(
            found["points"][name]["x"] - clicked[name]["x"],
            found["points"][name]["y"] - clicked[name]["y"],
        )
        for name in both
    ]
    assert np.median(off) < 10.0
    assert found["doubtful"] == []
    mask = np.asarray(Image.open(io.BytesIO(base64.b64decode(found["mask"]))))
    assert mask.shape == (found["image_size"]["height"], found["image_size"]["width"]) == (960, 720)
    ((left, top, right, bottom),) = found["persons"]
    assert mask[int((top + bottom) / 2), int((left + right) / 2)] > 127
    assert mask[2, 2] < 10


def test_a_fit_of_proposed_points_and_one_that_proposes_them_itself_agree(client: httpx.Client):
    sample = load_sample()
    found = client.post("/v1/points", files=picture(sample.image)).raise_for_status().json()
    sent = fitted(client, sample.image, points=found["points"])
    auto = fitted(client, sample.image, points="auto")
    assert set(assumed(sent)) == set(assumed(auto)) == found["points"].keys()
    for result in (sent, auto):
        (view,) = result["views"]
        assert view["outcome"] == "converged"
        assert view["silhouette_overlap"] > 0.93
        measured = {each["name"]: each["value"] for each in result["measurements"]}
        for name in ("waist_girth_navel", "hip_girth"):
            assert measured[name] == pytest.approx(sample.truth[name], rel=0.08)


def test_one_click_says_who_is_meant(client: httpx.Client):
    sample = load_sample()
    (view,) = json.loads(sample.request)["views"]
    knee = view["points"]["left_knee"]
    result = fitted(client, sample.image, points={"left_knee": knee}, complete_points=True)
    assert "left_knee" not in assumed(result)
    assert "right_knee" in assumed(result)


def test_a_fit_of_a_picture_of_nobody_says_so(client: httpx.Client):
    wall = np.random.default_rng(3).integers(90, 110, (480, 640, 3), dtype=np.uint8)
    encoded = io.BytesIO()
    Image.fromarray(wall).save(encoded, "PNG")
    nobody = client.post("/v1/points", files=picture(encoded.getvalue())).raise_for_status().json()
    assert "nobody-found" in {each["code"] for each in nobody["findings"]}
    answer = client.post(
        "/v1/fits",
        files=picture(encoded.getvalue()),
        data={"request": json.dumps(PERSON)},
    )
    problem = ended_job(client, answer)["problem"]
    assert problem["type"] == "/problems/unusable-input"
    assert (problem["field"], problem["code"]) == ("views.0.points", "person-not-found")


STOUT = {"weight_kg": 70.0, "measurements": {"waist_girth_navel": 160.0}}


def test_bodies_and_poses_are_answered_at_once_and_contradictions_by_the_fit(
    service: httpx.Client, tmp_path: Path
):
    client = service
    sample = load_sample()
    subject = json.loads(sample.request)
    (view,) = subject.pop("views")
    known = {"gender": "female", "height_m": 1.68, "weight_kg": 64.5}
    estimate = client.post("/v1/bodies", json=known).raise_for_status().json()
    weight = next(each for each in estimate["measurements"] if each["name"] == "weight")
    assert abs(weight["value"] - 64.5) < 0.1
    glb = client.post("/v1/bodies?format=glb", json=known)
    (tmp_path / "body.glb").write_bytes(glb.content)
    mesh = trimesh.load_mesh(tmp_path / "body.glb")
    assert mesh.is_watertight
    assert 50.0 < 1000.0 * mesh.volume < 80.0

    picture = {"image": ("sample.jpg", sample.image, "image/jpeg")}
    image = client.post("/v1/images", files=picture).raise_for_status().json()
    seen = view | {"image_size": {side: image[side] for side in ("width", "height")}}
    pose = client.post("/v1/initial-poses", json=subject | seen).raise_for_status().json()
    assert pose["camera"]["width"] == image["width"]

    seen = view | {"image_id": image["id"]}
    refused = ended_job(client, client.post("/v1/fits", json=subject | {"views": [seen]} | STOUT))
    assert refused["state"] == "failed"
    assert refused["problem"]["code"] == "contradictory-measurements"


def test_a_fit_by_the_papers_method_has_its_energies_alone_and_says_what_differs(
    service: httpx.Client,
):
    (sent,) = small_submissions(1)
    request = json.loads(sent.request) | {
        "cues": "SES",
        "force": True,
        "paper": {"energies": ["silhouette", "penetration", "shading"]},
    }
    answer = service.post(
        "/v1/fits",
        files={"image": ("picture.png", sent.image, "image/png")},
        data={"request": json.dumps(request)},
    )
    job = ended_job(service, answer)
    assert job["state"] == "succeeded", job
    result = FitResult.model_validate_json(service.get(job["links"]["result"]).content)
    assert set(result.energies) <= {"silhouette", "penetration", "shading"}
    assert "silhouette" in result.energies
    assert any("MakeHuman" in each for each in result.differences)
    assert all(each.standard_error in (None, 0.0) for each in result.measurements)
    assert service.get(job["links"]["request"]).json()["paper"] == {
        "energies": ["silhouette", "penetration", "shading"],
        "free_height": False,
    }
