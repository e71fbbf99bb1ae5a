"""The result as it is looked at: how good it is, and what is shown first."""

import json
import re
from collections.abc import Callable
from typing import Any

import httpx
import pytest
from playwright.sync_api import Browser, Route, expect

from tests.e2e.page.visitor import FIT_WITHIN_MS, LABELS_ARE_SEEN, PHONE, Visitor

RESULT = re.compile(r"/v1/fits/[0-9a-f-]{36}/result(\?|$)")
SURE: dict[str, Any] = {"outcome": "converged", "findings": [], "warnings": []}


def as_if(visitor: Visitor, view: dict[str, Any] | None = None, **changed: Any) -> None:
    """Let the page read another result than the fit's, also of its picture."""

    def other(result: dict) -> dict:
        return result | {"views": [result["views"][0] | (view or {})]} | changed

    visitor.page.route(RESULT, rewritten(other))


def rewritten(change: Callable[[dict], dict]) -> Callable[[Route], None]:
    def answer(route: Route) -> None:
        response = route.fetch()
        route.fulfill(response=response, body=json.dumps(change(response.json())))

    return answer


def open_fit(visitor: Visitor, fit: str) -> None:
    visitor.page.goto(f"{visitor.origin}/#/fits/{fit}")
    visitor.wait_for_result()


def test_the_first_line_says_how_good_a_fit_is_and_intervals_are_explained(
    visitor: Visitor, finished_fit: str
):
    as_if(visitor, SURE, verdict="plausible", warnings=[])
    open_fit(visitor, finished_fit)
    first = visitor.page.locator(".result-head p").first
    expect(first).to_have_text("Good: nothing is in doubt.")
    expect(visitor.page.get_by_text("the true value lies in it 95% of the time")).to_be_visible()
    expect(visitor.page.locator(".is-unreliable")).to_have_count(0)


def test_measurements_of_a_poor_fit_are_grey_and_say_why(visitor: Visitor, finished_fit: str):
    as_if(visitor, {"outcome": "poor_fit"}, verdict="plausible")
    open_fit(visitor, finished_fit)
    page = visitor.page
    expect(page.locator("[data-grade]")).to_have_attribute("data-grade", "poor")
    expect(page.get_by_text("Shown in grey because the body does not fit")).to_be_visible()
    expect(page.get_by_text("the true value lies in it")).to_have_count(0)
    value, soft = (
        page.locator(where).first.evaluate("each => getComputedStyle(each).color")
        for where in (".measures.is-unreliable tbody .number", ".panel .fine")
    )
    assert value == soft


@pytest.mark.parametrize("size", [(640, 360), (720, 450), (853, 573)], ids=str)
def test_a_zoomed_window_shows_the_body_large_and_lets_one_scroll(
    browser: Browser, service: httpx.Client, finished_fit: str, size: tuple[int, int]
):
    """A window of 1280 or 1440 pixels at 150 or 200 % is as small as this."""
    window = {"viewport": {"width": size[0], "height": size[1]}}
    with Visitor.at(browser, str(service.base_url), window) as visitor:
        open_fit(visitor, finished_fit)
        box = visitor.body.bounding_box()
        assert box["height"] > 380
        assert not visitor.page.evaluate("document.documentElement.scrollWidth > innerWidth")
        row = visitor.page.get_by_role("row", name=re.compile("^Weight"))
        row.scroll_into_view_if_needed()
        expect(row).to_be_in_viewport()


def test_a_stage_taller_than_wide_shows_the_arms_to_their_hands(
    browser: Browser, service: httpx.Client, finished_fit: str
):
    window = {"viewport": {"width": 920, "height": 1900}}
    with Visitor.at(browser, str(service.base_url), window) as visitor:
        open_fit(visitor, finished_fit)
        page = visitor.page
        page.get_by_role("button", name="Wrist", exact=True).click()
        page.get_by_role("heading", name="The body", exact=True).hover()
        visitor.wait_until_drawn(placement="canonical", marked="wrist_girth")
        box = visitor.body.bounding_box()
        assert box["height"] > 2 * box["width"]
        at = float(page.locator(".tape-labels line.is-marked").get_attribute("x2"))
        assert 0 < at < box["width"]


def test_measurements_are_there_before_the_bodies_and_how_much_of_them_is_told(
    visitor: Visitor, finished_fit: str
):
    page = visitor.page
    held: list[Route] = []
    bodies = re.compile(r"\.glb$")
    page.route(bodies, lambda route: held.append(route))
    page.goto(f"{visitor.origin}/#/fits/{finished_fit}")
    expect(page.get_by_role("row", name=re.compile("^Weight"))).to_be_visible()
    expect(page.locator("[data-grade]")).to_be_visible()
    expect(page.get_by_role("progressbar", name="The body is loading")).to_be_visible()
    expect(page.get_by_text("The body is loading: 0%")).to_be_visible()
    expect(page.locator(".bench-stage").get_by_alt_text("The picture")).to_be_visible()
    expect(page.locator(".body-canvas")).to_have_count(0)
    # Before the rule goes: with it the browser lets go what is held.
    for route in held:
        route.continue_()
    page.unroute(bodies)
    visitor.wait_for_result()
    expect(page.get_by_role("progressbar", name="The body is loading")).to_have_count(0)


def test_the_body_is_looked_at_from_its_sides_and_stands_on_a_floor(
    visitor: Visitor, finished_fit: str
):
    open_fit(visitor, finished_fit)
    page = visitor.page
    visitor.choose("Photo")
    beside = page.get_by_role("img", name="The body from the side")
    expect(beside).to_have_attribute("data-shows", "clay")
    visitor.choose("Body")
    visitor.unfold_for_experts()
    visitor.choose("As in the picture")
    seen = visitor.wait_until_drawn(placement="turned")
    for side in ("side", "back", "front"):
        page.get_by_role("button", name=f"From the {side}", exact=True).click()
        seen = visitor.wait_for_change(visitor.body, seen, share=0.02)
    expect(beside).to_have_count(0)


def test_tapes_are_labelled_and_marked_from_the_table_and_from_the_body(
    visitor: Visitor, finished_fit: str
):
    open_fit(visitor, finished_fit)
    page = visitor.page
    labels = page.get_by_role("group", name="Measurements on the body")
    hip = labels.get_by_role("button", name=re.compile(r"^Hip \d"))
    row = page.get_by_role("row", name=re.compile(r"^Hip \d"))
    value = row.locator(".number").first.inner_text()
    expect(hip).to_contain_text(value.split()[0])
    hip.hover()
    expect(row).to_have_class("is-pointed")
    visitor.wait_until_drawn(placement="canonical", marked="hip_girth")
    page.get_by_role("heading", name="The body", exact=True).hover()
    expect(row).not_to_have_class("is-pointed")
    hip.click()
    expect(row).to_be_in_viewport()
    page.get_by_role("heading", name="The body", exact=True).hover()
    expect(row).to_have_class("is-pointed")
    row.scroll_into_view_if_needed()
    page.get_by_role("button", name="Chest", exact=True).hover()
    expect(labels.get_by_role("button", name=re.compile(r"^Chest \d"))).to_have_class(
        re.compile("is-marked")
    )
    visitor.choose("in, lb")
    expect(hip).to_contain_text(str(round(float(value.split()[0]) / 2.54, 1)))


def test_four_figures_the_tapes_and_the_skin_are_there_without_asking(
    browser: Browser, service: httpx.Client, finished_fit: str
):
    """On a phone without scrolling; the skin is asked for once, by the page itself."""
    with Visitor.at(browser, str(service.base_url), PHONE) as visitor:
        open_fit(visitor, finished_fit)
        page = visitor.page
        figures = page.locator(".figures")
        for name in ("Chest", "Waist", "Hip", "Weight"):
            expect(figures.get_by_text(name, exact=True)).to_be_in_viewport(ratio=1)
        expect(figures).to_contain_text(re.compile(r"Chest\s*[\d.]+ cm\s*[\d.]+ – [\d.]+"))
        visitor.wait_until_drawn(placement="canonical")
        beside = page.locator(".look-beside canvas")
        expect(beside).to_have_attribute("data-shows", "texture", timeout=FIT_WITHIN_MS)
        page.get_by_role("button", name="Show the body in its skin, large").tap()
        skin = page.get_by_role("img", name="The textured body; arrow keys turn it")
        expect(skin).to_have_attribute("data-shows", "texture")
        expect(page.get_by_role("radio", name="Skin", exact=True)).to_be_checked()


def test_on_the_narrowest_phone_nothing_is_wider_than_the_window(
    browser: Browser, service: httpx.Client, finished_fit: str
):
    narrow = {"viewport": {"width": 320, "height": 568}}
    with Visitor.at(browser, str(service.base_url), narrow) as visitor:
        visitor.page.goto(f"{visitor.origin}/#/fits/{finished_fit}")
        visitor.wait_for_result()
        assert not visitor.page.evaluate("document.documentElement.scrollWidth > innerWidth")


def test_no_label_of_a_tape_lies_below_the_skin(
    browser: Browser, service: httpx.Client, finished_fit: str
):
    window = {"viewport": {"width": 1024, "height": 768}}
    with Visitor.at(browser, str(service.base_url), window) as visitor:
        visitor.page.goto(f"{visitor.origin}/#/fits/{finished_fit}")
        visitor.wait_for_result()
        for side in ("From the side", "From the back"):
            visitor.page.get_by_role("button", name=side).click()
            visitor.page.wait_for_function(LABELS_ARE_SEEN)
