"""The first screen: what this is, how good, what becomes of pictures, one way in, a body."""

import re
from typing import Any

import httpx
import pytest
from playwright.sync_api import Browser, expect

from tests.e2e.page.test_for_everyone import axe, serious_findings
from tests.e2e.page.visitor import DESK, PHONE, Visitor

__all__ = ["axe"]

MOVED = "(strip) => getComputedStyle(strip).transform"


@pytest.mark.parametrize("device", [DESK, PHONE], ids=["desk", "phone"])
def test_the_first_screen_tells_all_without_scrolling(
    browser: Browser, service: httpx.Client, device: dict[str, Any]
):
    with Visitor.at(browser, str(service.base_url), device) as visitor:
        page = visitor.page
        for told in (
            page.get_by_role("heading", level=1),
            page.get_by_text(re.compile(r"\d\.\d to \d\.\d cm off on average")),
            page.get_by_text("7 days after the last use"),
            page.get_by_text("from the front and from the side"),
            page.get_by_role("button", name="The body found in the first sample"),
        ):
            expect(told).to_be_in_viewport()


def test_a_phone_is_not_told_to_drop_pictures(browser: Browser, service: httpx.Client):
    for device, is_phone in ((DESK, False), (PHONE, True)):
        with Visitor.at(browser, str(service.base_url), device) as visitor:
            page = visitor.page
            take = page.get_by_label("Take or choose a picture", exact=True)
            expect(take).to_have_count(1 if is_phone else 0)
            expect(page.get_by_text("drop a picture here")).to_have_count(0 if is_phone else 1)


def test_the_figures_are_a_link_away(browser: Browser, service: httpx.Client, axe: str):
    with Visitor.at(browser, str(service.base_url)) as visitor:
        page = visitor.page
        page.get_by_role("link", name="All figures").click()
        expect(page.get_by_role("row", name=re.compile("^Front and side 1"))).to_be_visible()
        assert serious_findings(page, axe) == []
        page.get_by_role("link", name="Choose a picture").click()
        expect(page.get_by_role("heading", name="A body in 3D")).to_be_visible()


def test_the_body_turns_and_can_be_held(visitor: Visitor):
    page = visitor.page
    page.emulate_media(reduced_motion="no-preference")
    strip = page.locator(".turning-strip")
    first = strip.evaluate(MOVED)
    page.wait_for_function(
        "([strip, first]) => getComputedStyle(strip).transform !== first",
        arg=[strip.element_handle(), first],
    )
    figure = page.get_by_role("button", name="The body found in the first sample")
    figure.click()
    expect(strip).to_have_css("animation-play-state", "paused")
    figure.click()
    expect(strip).to_have_css("animation-play-state", "running")


def test_whoever_wants_little_motion_sees_it_stand(visitor: Visitor):
    page = visitor.page
    page.emulate_media(reduced_motion="reduce")
    expect(page.locator(".turning-strip")).to_have_css("animation-name", "none")


def test_without_an_answer_no_time_is_named(visitor: Visitor):
    page = visitor.page
    page.route(
        lambda url: url == visitor.origin + "/",
        lambda route: (
            route.continue_()
            if route.request.is_navigation_request()
            else route.fulfill(status=503, body="")
        ),
    )
    page.reload()
    expect(page.get_by_text("some time after the last use")).to_be_visible()
