"""Pictures that fail at the first look, in the decoder or in the fit: a named problem each."""

import io
import json

import httpx
import numpy as np
import pytest
from PIL import Image

from tests.e2e.service import ended_job
from tests.heif_files import SAMPLE_LYING, coded, phone_picture

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


def halved_heic() -> bytes:
    """Cut in the middle of the pixels."""
    return halved(phone_picture(coded(SAMPLE_LYING), orientation=6, quarters=3))


NOISE = encoded(noise(), "PNG")


@pytest.fixture(scope="module")
def client(service: httpx.Client) -> httpx.Client:
    return service


@pytest.mark.parametrize(
    ("image", "mask", "points", "field", "code"),
    [
        (halved(encoded(noise(), "JPEG")), None, POINTS, "image", "image-damaged"),
        (halved(encoded(noise(), "PNG")), None, POINTS, "image", "image-damaged"),
        (
            encoded(Image.new("RGB", SIZE, "grey"), "PNG"),
            None,
            POINTS,
            "image",
            "person-not-found",
        ),
        (
            NOISE,
            encoded(Image.new("L", SIZE, 0), "PNG"),
            POINTS,
            "mask",
            "mask-without-foreground",
        ),
        (
            NOISE,
            encoded(Image.new("L", SIZE, 255), "PNG"),
            POINTS,
            "mask",
            "mask-without-background",
        ),
    ],
    ids=[
        "truncated JPEG",
        "truncated PNG",
        "nobody there",
        "mask of nothing",
        "mask of everything",
    ],
)
def test_what_only_the_fit_can_find_wrong_ends_as_a_problem(
    client, image, mask, points, field, code
):
    files = {"image": image} | ({} if mask is None else {"mask": mask})
    request = {"gender": "female", "height_m": 1.7, "views": [{"points": points}], "cues": "SE"}
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


@pytest.mark.parametrize(
    "image", [halved(encoded(noise(), "WEBP")), halved_heic()], ids=["WebP", "HEIC"]
)
def test_kinds_that_say_how_long_they_are_are_refused_at_once_if_they_are_not(client, image):
    request = {"gender": "female", "height_m": 1.7, "views": [{"points": POINTS}]}
    answer = client.post("/v1/fits", files={"image": image}, data={"request": json.dumps(request)})
    assert answer.status_code == httpx.codes.UNPROCESSABLE_ENTITY
    problem = answer.json()
    assert (problem["field"], problem["code"]) == ("views.0.image", "image-damaged")
    assert problem["remedy"]
