"""What is made of a finished fit: asked for, looked at, kept."""

import re
from collections.abc import Callable

import pytest
from playwright.sync_api import Request, expect

from tests.e2e.page.visitor import FIT_WITHIN_MS, Visitor


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
    page.get_by_role("button", name="Make the page").click()
    file = card(looking, "print").locator(".download", has_text=".html")
    expect(file).to_be_visible(timeout=FIT_WITHIN_MS)
    with page.expect_download() as download:
        file.click()
    assert b"<html" in download.value.path().read_bytes()[:200]


@pytest.mark.parametrize(
    ("kind", "label", "button", "turned"),
    [
        ("pose", "Other pose", "Make the pose", "The body in this pose"),
        ("caricature", "Caricature", "Make the caricature", "The caricature"),
        ("animation", "Animation", "Make the animation", "The body in motion, to turn"),
        ("texture", "Texture", "Make the texture", "The textured body"),
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
    body = page.get_by_role("img", name=f"{turned}; arrow keys turn it")
    expect(body).to_have_attribute("data-shows", re.compile("clay|texture"))
    page.keyboard.press("Escape")
    looking.wait_until_drawn(placement="canonical")
    card(looking, kind).get_by_role("button", name="Turn it").click()
    expect(body).to_be_visible()
    page.get_by_role("button", name="Back to the body").click()
    looking.wait_until_drawn(placement="canonical")


def test_what_is_no_motion_is_told(looking: Visitor):
    page = looking.page
    looking.choose("Animation")
    page.get_by_label("Choose a BVH file").set_input_files(
        {"name": "dance.bvh", "mimeType": "text/plain", "buffer": b"no motion"}
    )
    expect(page.get_by_text("It moves as dance.bvh says.")).to_be_visible()
    page.get_by_role("button", name="Make the animation").click()
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
