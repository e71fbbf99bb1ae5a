"""Pictures of every kind: a phone's HEIC, and those that fail, with a named problem each."""

import io
import json

import httpx
import numpy as np
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


SIZE = (300, 400)
POINTS = {
    "nose": [150, 60],
    "left_shoulder": [185, 110],
    "right_shoulder": [115, 110],
    "left_elbow": [205, 165],
    "right_elbow": [95, 165],
    "left_wrist": [215, 215],
    "right_wrist": [85, 215],
    "left_hip": [170, 215],
    "right_hip": [130, 215],
    "left_knee": [172, 290],
    "right_knee": [128, 290],
    "left_ankle": [172, 360],
    "right_ankle": [128, 360],
}


def encoded(picture: Image.Image, kind: str) -> bytes:
    stream = io.BytesIO()
    picture.save(stream, kind)
    return stream.getvalue()


def noise() -> Image.Image:
    pixels = np.random.default_rng(1).integers(0, 256, (*SIZE[::-1], 3), dtype=np.uint8)
    return Image.fromarray(pixels)


def halved(content: bytes) -> bytes:
    return content[: len(content) // 2]


NOISE = encoded(noise(), "PNG")


@pytest.mark.parametrize(
    ("image", "mask", "field", "code"),
    [
        (halved(encoded(noise(), "JPEG")), None, "image", "image-damaged"),
        (
            NOISE,
            encoded(Image.new("L", SIZE, 0), "PNG"),
            "mask",
            "mask-without-foreground",
        ),
    ],
    ids=["truncated JPEG", "mask of nothing"],
)
def test_what_only_the_fit_can_find_wrong_ends_as_a_problem(client, image, mask, field, code):
    files = {"image": image} | ({} if mask is None else {"mask": mask})
    request = {"gender": "female", "height_m": 1.7, "views": [{"points": POINTS}], "cues": "SE"}
    job = ended_job(
        client, client.post("/v1/fits", files=files, data={"request": json.dumps(request)})
    )
    assert job["state"] == "failed"
    problem = job["problem"]
    assert problem["type"] == "/problems/unusable-input"
    assert problem["field"] == f"views.0.{field}"
    assert problem["code"] == code
    assert problem["errors"][0]["reason"]
    assert problem["remedy"]
    assert job["attempt"] == 1
