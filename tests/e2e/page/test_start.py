"""The first screen, and the page without a connection."""

import json
import re
import subprocess
import sys
from pathlib import Path
from typing import Any

import httpx
import pytest
from playwright.sync_api import Browser, expect

from tests.e2e.page.test_proposals import WOMAN
from tests.e2e.page.visitor import DESK, LIMBS, PHONE, Visitor, serious_findings

MOVED = "(strip) => getComputedStyle(strip).transform"


@pytest.mark.parametrize("device", [DESK, PHONE], ids=["desk", "phone"])
def test_the_first_screen_tells_all_without_scrolling(
    browser: Browser, service: httpx.Client, device: dict[str, Any]
):
    with Visitor.at(browser, str(service.base_url), device) as visitor:
        page = visitor.page
        for told in (
            page.get_by_role("heading", level=1),
            page.get_by_text(re.compile(r"typically within \d\.\d cm")),
            page.get_by_text("7 days after the last use"),
            page.get_by_text("from the front and from the side"),
            page.get_by_role("button", name="The body found in the first sample"),
        ):
            expect(told).to_be_in_viewport()
        # A phone is not told to drop pictures.
        take = page.get_by_label("Take or choose a picture", exact=True)
        expect(take).to_have_count(int(device is PHONE))
        expect(page.get_by_text("drop a picture here")).to_have_count(int(device is DESK))


def test_the_figures_are_a_link_away(visitor: Visitor, axe: str):
    page = visitor.page
    page.get_by_role("link", name="All figures").click()
    expect(page.get_by_role("row", name=re.compile("^Front and side 1"))).to_be_visible()
    assert serious_findings(page, axe) == []
    page.get_by_role("link", name="Choose a picture").click()
    expect(page.get_by_role("heading", name="Your measurements and your body")).to_be_visible()


def test_developers_see_what_programs_get(visitor: Visitor, axe: str, tmp_path: Path):
    page = visitor.page
    page.goto(f"{visitor.origin}/try")
    page.get_by_role("button", name="Send the sample").click()
    expect(page.get_by_role("img", name="Body")).to_have_attribute("data-shows", re.compile("."))
    assert serious_findings(page, axe) == []
    shown = json.loads(page.get_by_label("Response", exact=True).input_value())["measurements"]
    node = ("node", "--input-type=module", "-e")
    programs = {"curl": ("bash", "-c"), "fetch": node, "Python": (sys.executable, "-c")}
    for name, program in programs.items():
        visitor.choose(name)
        text = page.locator("textarea").nth(1).input_value()
        told = subprocess.run((*program, text), cwd=tmp_path, stdout=subprocess.PIPE, check=True)
        assert json.loads(told.stdout)["measurements"] == shown


def test_the_body_turns_unless_motion_is_unwanted_and_can_be_held(visitor: Visitor):
    page = visitor.page
    strip = page.locator(".turning-strip")
    expect(strip).to_have_css("animation-name", "none")
    page.emulate_media(reduced_motion="no-preference")
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


NO_CONNECTION = "There is no connection to the service."
GOES_ON = "There is no connection. The service goes on"


def test_offline_is_said_and_all_is_sent_once_it_is_over(visitor: Visitor):
    page = visitor.page
    visitor.open_sample()
    visitor.describe_person()
    expect(page.get_by_text(NO_CONNECTION)).to_have_count(0)
    page.context.set_offline(True)
    expect(page.get_by_text(NO_CONNECTION)).to_be_visible()
    visitor.click_points(LIMBS)
    page.context.set_offline(False)
    expect(page.get_by_text(NO_CONNECTION)).to_have_count(0)
    expect(page.locator(".live-outline")).to_be_attached()


def test_a_picture_chosen_offline_is_uploaded_later(visitor: Visitor):
    page = visitor.page
    visitor.open_sample()
    page.context.set_offline(True)
    page.get_by_label("Choose another picture").set_input_files(WOMAN)
    # Nobody proposes its points now, so that the page itself unfolds where they are clicked.
    expect(page.get_by_text(WOMAN.name)).to_be_visible()
    expect(page.get_by_text(NO_CONNECTION)).to_be_visible()
    with page.expect_response("**/v1/images") as answer:
        page.context.set_offline(False)
    assert answer.value.ok
    expect(page.get_by_text(NO_CONNECTION)).to_have_count(0)


def test_a_fit_whose_news_breaks_off_is_shown_once_there_is_a_connection_again(visitor: Visitor):
    page = visitor.page
    visitor.open_sample(with_points=True)
    visitor.wait_for_whole_picture()
    page.route("**/v1/fits/*/events", lambda route: route.abort())
    page.route("**/v1/fits/*/cancel", lambda route: route.abort())
    visitor.let_fits_take_minutes()
    visitor.submit()
    expect(page.get_by_text(GOES_ON)).to_be_visible()
    page.get_by_role("button", name="Cancel").click()
    expect(page.get_by_role("button", name="Cancel")).to_be_enabled()
    page.unroute("**/v1/fits/*/events")
    page.unroute("**/v1/fits/*/cancel")
    expect(page.get_by_text(GOES_ON)).to_have_count(0)
    page.get_by_role("button", name="Cancel").click()
    expect(page.get_by_role("heading", name="Canceled")).to_be_visible()
