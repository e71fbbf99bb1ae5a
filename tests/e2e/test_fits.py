"""Questions and fits by the service as a user starts it: points, bodies, the paper's method."""

import base64
import io
import json

import httpx
import numpy as np
import pytest
from PIL import Image

from service.demo_data.sample import load_sample
from tests.e2e.service import ended_job, wait_for_estimator

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
