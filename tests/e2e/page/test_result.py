"""The result as it is looked at: how good it is, what is shown first, what is withheld."""

import json
import re
from collections.abc import Callable
from typing import Any

import httpx
import numpy as np
import pytest
from PIL import Image
from playwright.sync_api import Browser, Route, expect

from fitter.vocabulary.choices import Cues
from tests.e2e.page.visitor import FIT_WITHIN_MS, LABELS_ARE_SEEN, PHONE, VISIBLY, Visitor
from tests.e2e.service import ended_job
from tests.integration.nonsense import nonsense

RESULT = re.compile(r"/v1/fits/[0-9a-f-]{36}/result(\?|$)")


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


def test_measurements_of_a_poor_fit_are_grey_and_say_why(visitor: Visitor, finished_fit: str):
    as_if(visitor, {"outcome": "poor_fit"}, verdict="plausible")
    open_fit(visitor, finished_fit)
    page = visitor.page
    expect(page.locator("[data-grade]")).to_have_attribute("data-grade", "poor")
    expect(page.get_by_text("Shown in grey because the body does not match")).to_be_visible()
    expect(page.get_by_text("the true value lies in it")).to_have_count(0)
    value, soft = (
        page.locator(where).first.evaluate("each => getComputedStyle(each).color")
        for where in (".measures.is-unreliable tbody .number", ".panel .fine")
    )
    assert value == soft


def test_a_zoomed_window_shows_the_body_large_and_lets_one_scroll(
    browser: Browser, service: httpx.Client, finished_fit: str
):
    """A window of 1280 pixels at 200 % is as small as this."""
    window = {"viewport": {"width": 640, "height": 360}}
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
    # No tape was laid about another body.
    page.get_by_text("Try another weight or waist").click()
    page.locator(".what-if input").first.fill("5")
    expect(page.locator(".what-if")).to_contain_text(re.compile(r"Most likely, then: Chest \d"))
    expect(hip).to_have_count(0)


def test_four_figures_the_colours_and_the_tapes_are_there_without_asking(
    browser: Browser, service: httpx.Client, finished_fit: str
):
    """On a phone without scrolling; the body in colour comes first."""
    with Visitor.at(browser, str(service.base_url), PHONE) as visitor:
        page = visitor.page
        page.goto(f"{visitor.origin}/#/fits/{finished_fit}")
        expect(page.get_by_role("radio", name="In colour", exact=True)).to_be_checked()
        colours = page.get_by_role("img", name="The body in colour; arrow keys rotate it")
        expect(colours).to_have_attribute("data-shows", "texture", timeout=FIT_WITHIN_MS)
        share = page.get_by_role("button", name="Share a picture of the body")
        with page.expect_download() as download:
            share.click()
        with Image.open(download.value.path()) as picture:
            assert np.asarray(picture.convert("L")).std() > VISIBLY  # not the ground alone
        page.get_by_role("button", name="History").click()
        expect(page.get_by_role("dialog")).to_contain_text(re.compile(r"Waist [\d.]+ cm"))
        page.keyboard.press("Escape")
        visitor.choose("Body")
        figures = page.locator(".figures")
        for name in ("Chest", "Waist", "Hip", "Weight"):
            expect(figures.get_by_text(name, exact=True)).to_be_in_viewport(ratio=1)
        expect(figures).to_contain_text(re.compile(r"Chest\s*[\d.]+ cm\s*[\d.]+ – [\d.]+"))
        visitor.wait_until_drawn(placement="canonical")
        beside = page.locator(".look-beside canvas")
        expect(beside).to_have_attribute("data-shows", "texture", timeout=FIT_WITHIN_MS)
        page.get_by_role("button", name="Show the body in colour, large").tap()
        expect(colours).to_have_attribute("data-shows", "texture")
        expect(page.get_by_role("radio", name="In colour", exact=True)).to_be_checked()
        page.set_viewport_size({"width": 320, "height": 568})
        assert not page.evaluate("document.documentElement.scrollWidth > innerWidth")


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


@pytest.fixture(scope="module")
def fit_of_hills(service: httpx.Client) -> dict:
    asked = nonsense(Cues.SES)["landscape"]
    (view,) = asked.views
    request = {
        "gender": asked.person.gender,
        "height_m": asked.person.height_m,
        "views": [
            {"points": {name: {"x": each.x, "y": each.y} for name, each in view.clicks.items()}}
        ],
    }
    files = {
        "image": ("hills.jpg", view.image, "image/jpeg"),
        "request": ("request.json", json.dumps(request), "application/json"),
    }
    return ended_job(service, service.post("/v1/fits", files=files))


def test_a_landscape_is_not_measured_and_the_page_says_so_and_measures_anyway(
    visitor: Visitor, service: httpx.Client, fit_of_hills: dict
):
    result = service.get(fit_of_hills["links"]["result"]).raise_for_status().json()
    assert (result["views"][0]["outcome"], result["verdict"]) == ("poor_fit", "no_person")
    assert result["measurements"] == []
    table = service.get(f"{fit_of_hills['links']['self']}/files/measurements.csv")
    assert table.raise_for_status().text.count("\n") == 1
    page = visitor.page
    page.goto(f"{visitor.origin}/#/fits/{fit_of_hills['id']}")
    heading = page.get_by_role("heading", name="The body does not match the points")
    expect(heading).to_be_visible()
    expect(page.locator(".quality")).to_contain_text("Nothing in the picture shows a body")
    expect(page.locator(".measures")).to_have_count(0)
    page.get_by_role("button", name="Measure anyway").click()
    expect(page.locator(".measures").first).to_be_visible(timeout=FIT_WITHIN_MS)
    expect(heading).to_be_visible()
    page.locator(".more-notes > summary").click()
    expect(page.get_by_text("You asked for measurements all the same")).to_be_visible()
