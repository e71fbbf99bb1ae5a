"""A phone's HEIC from upload to result, beside the same picture as a JPEG."""

import io
import json

import httpx
import pytest
from PIL import Image

from service.demo_data.sample import load_sample
from tests.e2e.service import ended_job, wait_for_estimator
from tests.heif_files import SAMPLE_LYING, coded, phone_picture

HEIC = phone_picture(coded(SAMPLE_LYING), orientation=6, quarters=3, focal_length_35mm=50)


@pytest.fixture(scope="module")
def client(service: httpx.Client) -> httpx.Client:
    wait_for_estimator(service)
    return service


def fitted(client: httpx.Client, image: bytes) -> dict:
    """The ended job of the sample's clicks in a picture."""
    request = json.loads(load_sample().request) | {"cues": "SE"}
    answer = client.post("/v1/fits", files={"image": image}, data={"request": json.dumps(request)})
    job = ended_job(client, answer)
    assert job["state"] == "succeeded", job["problem"]
    return job


def waist(client: httpx.Client, job: dict) -> float:
    result = client.get(job["links"]["result"]).raise_for_status().json()
    assert result["views"][0]["focal_length_source"] == "exif_35mm_equivalent"
    return next(
        each["value"] for each in result["measurements"] if each["name"] == "waist_girth_navel"
    )


def test_a_heic_gives_the_measurements_of_the_jpeg(client: httpx.Client):
    job = fitted(client, HEIC)
    of_jpeg = fitted(client, load_sample().image)
    assert waist(client, job) == pytest.approx(waist(client, of_jpeg), abs=1.5)
    shown = client.get(job["links"]["files"]["views/0/image"], headers={"Accept": "image/jpeg"})
    assert Image.open(io.BytesIO(shown.content)).size == (720, 960)
    assert client.get(job["links"]["files"]["views/0/image"]).content == HEIC


def test_two_heics_are_fitted_together(client: httpx.Client):
    request = {
        "gender": "male",
        "height_m": 1.804,
        "cues": "SE",
        "views": [{"view": "front"}, {"view": "other"}],
    }
    answer = client.post(
        "/v1/fits",
        files=[("image", HEIC), ("image", HEIC)],
        data={"request": json.dumps(request)},
    )
    job = ended_job(client, answer)
    assert job["state"] == "succeeded", job["problem"]
