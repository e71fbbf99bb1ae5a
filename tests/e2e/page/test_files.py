"""Files of every kind are taken as they are, also where this browser does not show them."""

import io

import pytest
from PIL import Image
from playwright.sync_api import Page, expect

from service.demo_data.sample import load_sample
from tests.e2e.page.visitor import Visitor
from tests.heif_files import SAMPLE_LYING, coded, phone_picture

SAMPLE = load_sample().image
HEIC = phone_picture(coded(SAMPLE_LYING), orientation=6, quarters=3, focal_length_35mm=50)


def written(picture: Image.Image, kind: str, **options: object) -> bytes:
    file = io.BytesIO()
    picture.save(file, kind, **options)
    return file.getvalue()


def sample() -> Image.Image:
    return Image.open(io.BytesIO(SAMPLE))


def choose(page: Page, label: str, content: bytes, name: str = "p.jpg") -> None:
    file = {"name": name, "mimeType": "", "buffer": content}
    page.get_by_label(label, exact=True).set_input_files(file)


@pytest.mark.parametrize(
    ("kind", "options"),
    [("JPEG", {"progressive": True}), ("PNG", {}), ("WEBP", {"lossless": True})],
)
def test_whole_pictures_of_every_kind_are_taken(visitor: Visitor, kind: str, options: dict):
    with visitor.page.expect_response("**/v1/images") as answer:
        choose(visitor.page, "Choose a picture", written(sample(), kind, **options))
    assert answer.value.status in (200, 201)
    visitor.wait_for_stage()


def test_a_heic_is_shown_by_way_of_the_service_and_fitted_as_it_is(visitor: Visitor):
    page = visitor.page
    with page.expect_response("**/v1/images") as answer:
        choose(page, "Choose a picture", HEIC, "p.heic")
    kept = answer.value.json()
    assert kept["media_type"] == "image/heic"
    visitor.wait_for_stage()
    visitor.correct()
    expect(page.get_by_text("720 × 960")).to_be_visible()
    page.get_by_role("heading", name="What the fit goes by").click()
    expect(page.get_by_text("Read from the picture.")).to_be_visible()
    visitor.describe_person()
    # Its points are proposed.
    assert visitor.sent_view()["image_id"] == kept["id"]
    # Its result is shown beside the picture in this browser as well.
    visitor.wait_for_result()
    visitor.wait_until_drawn(placement="canonical")


def test_what_neither_browser_nor_service_can_show_is_told(visitor: Visitor):
    page = visitor.page
    choose(page, "Choose a picture", b"no picture", "notes.txt")
    expect(page.get_by_role("alert")).to_contain_text("notes.txt: This is not a picture")
    expect(visitor.stage).to_have_count(0)
    choose(page, "Choose a picture", SAMPLE)
    visitor.wait_for_stage()
    expect(page.get_by_role("alert")).to_have_count(0)


def test_a_picture_that_is_too_small_is_told_beside_it(visitor: Visitor):
    choose(visitor.page, "Choose a picture", written(sample().resize((20, 27)), "JPEG"))
    expect(visitor.page.get_by_role("alert").first).to_contain_text("64")
