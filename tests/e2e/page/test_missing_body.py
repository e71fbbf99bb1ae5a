"""Without a gender there is no outline: that is said, and the way there is one click."""

import httpx
import pytest
from playwright.sync_api import Browser, expect

from tests.e2e.page.test_proposals import WOMAN, drop
from tests.e2e.page.visitor import DESK, LIMBS, PHONE, Visitor

MISSING = "Choose the body, then the outline appears."


@pytest.mark.parametrize("is_proposed", [False, True], ids=["clicked", "proposed"])
def test_the_missing_body_is_named_and_shown(visitor: Visitor, *, is_proposed: bool):
    page = visitor.page
    if is_proposed:
        drop(visitor, WOMAN.read_bytes())
        expect(visitor.points()).to_have_count(21)
        visitor.correct()
    else:
        visitor.open_sample()
        visitor.click_points(LIMBS)
        page.get_by_role("button", name="That is enough").click()
    card = page.locator(".next")
    link = card.get_by_role("button", name=MISSING)
    expect(link).to_be_visible()
    expect(card).not_to_contain_text("Does the outline")
    link.click()
    expect(page.get_by_role("radio", name="Female", exact=True)).to_be_focused()
    page.keyboard.press("Space")
    expect(page.locator(".live-outline")).to_be_attached()
    expect(link).not_to_be_attached()
    if not is_proposed:
        expect(card).to_contain_text("Does the outline lie on the person?")


@pytest.mark.parametrize("device", [DESK, PHONE], ids=["desk", "phone"])
def test_the_way_to_it_leads_out_of_a_full_screen(
    browser: Browser, service: httpx.Client, device: dict
):
    touching = {**device, "has_touch": True}
    with Visitor.at(browser, str(service.base_url), touching) as visitor:
        page = visitor.page
        visitor.open_sample()
        page.get_by_role("button", name="Fill the screen").click()
        visitor.wait_for_whole_picture()
        visitor.click_points(LIMBS)
        page.get_by_role("button", name="Enough points").click()
        page.locator(".next-line").get_by_role("button", name=MISSING).click()
        choice = page.get_by_role("radio", name="Female", exact=True)
        expect(choice).to_be_focused()
        expect(choice).to_be_in_viewport()
