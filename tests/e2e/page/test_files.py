"""A file is looked at when it is chosen: what cannot be fitted is told before anybody clicks."""

import io
import json
import re

import pytest
from PIL import Image
from playwright.sync_api import Page, expect

from service.demo_data.sample import load_sample
from tests.e2e.page.visitor import Visitor
from tests.heif_files import SAMPLE_LYING, coded, phone_picture

SAMPLE = load_sample().image
HEIC = phone_picture(coded(SAMPLE_LYING), orientation=6, quarters=3, focal_length_35mm=50)
EXIF_DIRECTORY, FOCAL_LENGTH_IN_35MM_FILM = 0x8769, 0xA405


def written(picture: Image.Image, kind: str, **options: object) -> bytes:
    file = io.BytesIO()
    picture.save(file, kind, **options)
    return file.getvalue()


def sample() -> Image.Image:
    return Image.open(io.BytesIO(SAMPLE))


def cut_off(kind: str) -> bytes:
    whole = written(sample(), kind)
    return whole[: len(whole) * 3 // 4]


def choose(page: Page, label: str, content: bytes, name: str = "p.jpg") -> None:
    file = {"name": name, "mimeType": "", "buffer": content}
    page.get_by_label(label, exact=True).set_input_files(file)


@pytest.mark.parametrize(
    ("content", "told"),
    [
        (lambda: cut_off("JPEG"), "p.jpg is cut off"),
        (lambda: cut_off("PNG"), "p.jpg is cut off"),
        (lambda: cut_off("WEBP"), "p.jpg is cut off"),
        (
            lambda: written(sample().resize((20, 27)), "JPEG"),
            "p.jpg has 20 × 27 pixels; at least 64",
        ),
        (lambda: written(sample().resize((64, 1400)), "PNG"), "less than 20 times as long as wide"),
    ],
    ids=["jpeg", "png", "webp", "tiny", "narrow"],
)
def test_what_cannot_be_fitted_is_told_where_it_is_chosen(visitor: Visitor, content, told: str):
    page = visitor.page
    choose(page, "Choose a picture", content())
    expect(page.get_by_role("alert")).to_contain_text(told)
    expect(visitor.stage).to_have_count(0)
    # Another that is good takes the words away.
    choose(page, "Choose a picture", SAMPLE)
    visitor.wait_for_stage()
    expect(page.get_by_role("alert")).to_have_count(0)
    # In place of a picture: the one before stays.
    visitor.correct()
    choose(page, "Choose another picture", content(), "q.jpg")
    expect(page.get_by_role("alert")).to_contain_text(re.sub(r"^p\.", "q.", told))
    expect(page.locator(".picture-name")).to_have_text("p.jpg")


@pytest.mark.parametrize(
    ("kind", "options"),
    [("JPEG", {"progressive": True}), ("PNG", {}), ("WEBP", {"lossless": True}), ("GIF", {})],
)
def test_whole_pictures_of_every_kind_are_taken(visitor: Visitor, kind: str, options: dict):
    with visitor.page.expect_response("**/v1/images") as answer:
        choose(visitor.page, "Choose a picture", written(sample(), kind, **options))
    assert answer.value.status in (200, 201)
    visitor.wait_for_stage()


def test_bytes_after_the_end_of_a_jpeg_do_no_harm(visitor: Visitor):
    choose(visitor.page, "Choose a picture", SAMPLE + b"film" * 1000)
    visitor.wait_for_stage()


def test_a_picture_too_large_for_the_service_is_scaled_down_and_keeps_its_lens(visitor: Visitor):
    exif = Image.Exif()
    exif.get_ifd(EXIF_DIRECTORY)[FOCAL_LENGTH_IN_35MM_FILM] = 28
    large = written(sample().resize((6200, 8300)), "JPEG", exif=exif, quality=60)
    page = visitor.page
    with page.expect_response("**/v1/images") as answer:
        choose(page, "Choose a picture", large)
    kept = answer.value.json()
    assert 11_900_000 < kept["width"] * kept["height"] <= 12_000_000
    assert kept["focal_length_35mm"] == 28
    assert kept["width"] / kept["height"] == pytest.approx(6200 / 8300, rel=1e-3)
    visitor.correct()
    expect(page.get_by_text("Scaled down from 6200 × 8300 pixels.")).to_be_visible()
    page.get_by_role("heading", name="Lens and light").click()
    expect(page.get_by_text("Read from the picture.")).to_be_visible()


def test_a_heic_is_shown_by_way_of_the_service_and_fitted_as_it_is(visitor: Visitor):
    page = visitor.page
    with page.expect_response("**/v1/images") as answer:
        choose(page, "Choose a picture", HEIC, "p.heic")
    kept = answer.value.json()
    assert kept["media_type"] == "image/heic"
    visitor.wait_for_stage()
    visitor.correct()
    expect(page.get_by_text("720 × 960")).to_be_visible()
    page.get_by_role("heading", name="Lens and light").click()
    expect(page.get_by_text("Read from the picture.")).to_be_visible()
    page.reload()
    visitor.wait_for_stage()
    visitor.describe_person()
    # Its points are proposed.
    assert visitor.sent_request()["image_id"] == kept["id"]
    # Its result is shown beside the picture in this browser as well.
    visitor.wait_for_result()
    visitor.wait_until_drawn(placement="canonical")


def test_where_no_heic_is_decoded_it_is_said_how_to_get_a_jpeg(visitor: Visitor):
    page = visitor.page
    refused = {"code": "heic-not-installed", "detail": "", "remedy": "", "title": "", "errors": []}
    problem = {**refused, "type": "/problems/unsupported-media-type", "status": 415}
    page.route(
        "**/v1/images",
        lambda route: route.fulfill(
            status=415, content_type="application/problem+json", body=json.dumps(problem)
        ),
    )
    choose(page, "Choose a picture", HEIC, "p.heic")
    expect(page.get_by_role("alert")).to_contain_text("Settings > Camera > Formats")
    expect(visitor.stage).to_have_count(0)
