"""Files of every kind go in, and what is made of a finished fit is looked at and kept."""

import re
from collections.abc import Callable

import pytest
from playwright.sync_api import Page, Request, expect

from service.demo_data.sample import load_sample
from tests.e2e.page.visitor import FIT_WITHIN_MS, Visitor
from tests.heif_files import SAMPLE_LYING, coded, phone_picture

SAMPLE = load_sample().image
HEIC = phone_picture(coded(SAMPLE_LYING), orientation=6, quarters=3, focal_length_35mm=50)


def choose(page: Page, label: str, content: bytes, name: str = "p.jpg") -> None:
    file = {"name": name, "mimeType": "", "buffer": content}
    page.get_by_label(label, exact=True).set_input_files(file)


def test_a_heic_is_shown_by_way_of_the_service_and_fitted_as_it_is(visitor: Visitor):
    page = visitor.page
    with page.expect_response("**/v1/images") as answer:
        choose(page, "Choose a picture", HEIC, "p.heic")
    kept = answer.value.json()
    assert kept["media_type"] == "image/heic"
    visitor.wait_for_stage()
    visitor.correct()
    expect(page.get_by_text("720 × 960")).to_be_visible()
    page.get_by_role("heading", name="Lens, shading and mask").click()
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


def asks_for(kind: str) -> Callable[[Request], bool]:
    """Whether a request does: the page asks for the skin by itself, at any time."""
    return lambda request: f'"kind":"{kind}"' in (request.post_data or "")


@pytest.fixture
def looking(visitor: Visitor, finished_fit: str) -> Visitor:
    visitor.page.goto(f"{visitor.origin}/#/fits/{finished_fit}")
    visitor.wait_for_result()
    return visitor


def card(visitor: Visitor, kind: str):
    return visitor.page.locator(f'.products [data-kind="{kind}"][data-state="succeeded"]')


def test_a_page_to_print_is_made_and_kept(looking: Visitor):
    page = looking.page
    looking.choose("Print")
    page.get_by_role("button", name="Create the page").click()
    file = card(looking, "print").locator(".download", has_text=".html")
    expect(file).to_be_visible(timeout=FIT_WITHIN_MS)
    with page.expect_download() as download:
        file.click()
    assert b"<html" in download.value.path().read_bytes()[:200]


@pytest.mark.parametrize(
    ("kind", "label", "button", "turned"),
    [
        ("pose", "Other pose", "Create the pose", "The body in this pose"),
        ("caricature", "Caricature", "Create the caricature", "The caricature"),
        ("animation", "Animation", "Create the animation", "The body in motion"),
        ("texture", "Texture", "Create the texture", "The body in colour"),
    ],
)
def test_bodies_are_shown_on_the_stage_and_left_for_the_fit(
    looking: Visitor, kind: str, label: str, button: str, turned: str
):
    page = looking.page
    looking.choose(label)
    with page.expect_request(asks_for(kind)):
        page.get_by_role("button", name=button).click()
    expect(card(looking, kind)).to_be_visible(timeout=FIT_WITHIN_MS)
    body = page.get_by_role("img", name=f"{turned}; arrow keys rotate it")
    expect(body).to_have_attribute("data-shows", re.compile("clay|texture"))
    page.keyboard.press("Escape")
    looking.wait_until_drawn(placement="canonical")
    card(looking, kind).get_by_role("button", name="Show large").click()
    expect(body).to_be_visible()
    page.get_by_role("button", name="Back to the body").click()
    looking.wait_until_drawn(placement="canonical")


def test_what_is_no_motion_is_told(looking: Visitor):
    page = looking.page
    looking.choose("Animation")
    choose(page, "Choose a BVH file", b"no motion", "dance.bvh")
    expect(page.get_by_text("It moves as dance.bvh says.")).to_be_visible()
    page.get_by_role("button", name="Create the animation").click()
    expect(page.get_by_role("alert")).to_contain_text("HIERARCHY", timeout=FIT_WITHIN_MS)


def test_a_size_is_found_in_a_chart(looking: Visitor):
    page = looking.page
    looking.choose("Clothing size")
    find = page.get_by_role("button", name="Find the size")
    expect(find).to_be_disabled()
    page.get_by_role("button", name="Use the example").click()
    find.click()
    expect(card(looking, "size")).to_contain_text("None fits", timeout=FIT_WITHIN_MS)


def test_body_fat_is_estimated(looking: Visitor):
    page = looking.page
    looking.choose("Body fat")
    page.get_by_role("button", name="Estimate it").click()
    expect(card(looking, "composition")).to_contain_text("composition.csv", timeout=FIT_WITHIN_MS)
