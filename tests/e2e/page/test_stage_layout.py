"""The picture and what is beside it, on phones and desks: nothing lies over what is tapped."""

import json
from typing import Any

import httpx
import pytest
from playwright.sync_api import Browser, expect

from service.demo_data.sample import FOLDER
from tests.e2e.page.test_for_everyone import axe, serious_findings
from tests.e2e.page.test_proposals import NOT_INSTALLED
from tests.e2e.page.visitor import DESK, LIMBS, PHONE, SAMPLE_POINTS, Visitor

__all__ = ["axe"]

SMALL_PHONE = PHONE | {"viewport": {"width": 360, "height": 640}}
LYING_PHONE = PHONE | {"viewport": {"width": 844, "height": 390}}
DEVICES = {"desk": DESK, "phone": PHONE, "small phone": SMALL_PHONE, "lying phone": LYING_PHONE}

LIES_ON_STAGE = """([x, y]) => document.elementFromPoint(x, y)?.closest(".stage") !== null"""
FOCUSED_LABEL = "document.activeElement.getAttribute('aria-label')"
GUIDE_IS_CUT = """() => {
  const line = document.querySelector(".next-line.is-guided");
  return line.scrollHeight > line.clientHeight || line.scrollWidth > line.clientWidth;
}"""


def of_all_devices(test: Any) -> Any:
    return pytest.mark.parametrize("device", DEVICES.values(), ids=list(DEVICES))(test)


@of_all_devices
def test_every_spot_of_the_picture_can_be_tapped(
    browser: Browser, service: httpx.Client, device: dict[str, Any]
):
    with Visitor.at(browser, str(service.base_url), device) as visitor:
        page = visitor.page
        visitor.open_sample()
        visitor.click_points(LIMBS[:-2])
        # There may be an end now, which is offered beside the picture.
        page.get_by_role("radio", name="Male", exact=True).check()
        tools = page.get_by_role("toolbar", name="Picture")
        expect(tools.get_by_role("button", name="Enough points")).to_be_attached()
        tools.scroll_into_view_if_needed()
        visitor.wait_for_whole_picture()
        corners = [(4.0, 4.0), (716.0, 4.0), (4.0, 956.0), (716.0, 956.0), (360.0, 956.0)]
        assert all(page.evaluate(LIES_ON_STAGE, visitor.on_stage(*each)) for each in corners)
        points = SAMPLE_POINTS
        for name in LIMBS[-2:]:
            page.mouse.click(*visitor.on_stage(points[name]["x"], points[name]["y"]))
        expect(visitor.points()).to_have_count(len(LIMBS))
        stage, bar = visitor.stage.bounding_box(), tools.bounding_box()
        assert stage is not None
        assert bar is not None
        below = bar["y"] >= stage["y"] + stage["height"] - 1
        beside = bar["x"] >= stage["x"] + stage["width"] - 1
        assert below or beside
        assert not page.evaluate("document.documentElement.scrollWidth > innerWidth")


@pytest.mark.parametrize("device", [PHONE, SMALL_PHONE, LYING_PHONE])
def test_the_picture_fills_the_screen_until_its_button_or_escape(
    browser: Browser, service: httpx.Client, device: dict[str, Any]
):
    with Visitor.at(browser, str(service.base_url), device) as visitor:
        page = visitor.page
        visitor.open_sample()
        before = visitor.stage.bounding_box()
        assert before is not None
        page.get_by_role("button", name="Fill the screen").tap()
        leave = page.get_by_role("button", name="Leave the full screen")
        expect(leave).to_be_focused()
        expect(page.locator(".next-line")).to_contain_text("Left shoulder")
        visitor.wait_for_width(visitor.stage, before["width"])
        visitor.wait_for_whole_picture()
        box = page.locator(".bench-stage").bounding_box()
        assert box == {"x": 0, "y": 0, **device["viewport"]}
        # What lies beneath takes no focus.
        labels = set()
        for _ in range(12):
            page.keyboard.press("Tab")
            labels.add(page.evaluate(FOCUSED_LABEL))
        assert "Zoom in" in labels
        assert not labels & {"Maquette: start", "Dark page", "Light page"}
        visitor.click_points(LIMBS, touch=True)
        visitor.stage.focus()
        page.keyboard.press("Escape")
        expect(leave).not_to_be_attached()
        expect(visitor.stage).to_be_focused()
        page.get_by_role("button", name="Fill the screen").tap()
        leave.tap()
        expect(page.get_by_role("button", name="Fill the screen")).to_be_focused()
        page.get_by_role("radio", name="Male", exact=True).tap()
        expect(page.locator(".live-outline")).to_be_attached()


def test_at_a_desk_the_window_has_room_enough(visitor: Visitor):
    visitor.open_sample()
    expect(visitor.page.get_by_role("button", name="Zoom in")).to_be_visible()
    expect(visitor.page.get_by_role("button", name="Fill the screen")).to_be_hidden()


def test_on_a_phone_the_person_comes_first_then_picture_and_points(
    browser: Browser, service: httpx.Client
):
    with Visitor.at(browser, str(service.base_url), PHONE) as visitor:
        page = visitor.page
        visitor.open_sample()
        expect(page.get_by_role("button", name="Choose female or male")).to_be_in_viewport()
        order = [
            page.get_by_role("radio", name="Male", exact=True),
            page.get_by_label("Height", exact=True),
            visitor.stage,
            page.get_by_role("toolbar", name="Picture"),
            page.get_by_role("heading", name="Points", exact=True),
        ]
        tops = [each.bounding_box()["y"] for each in order]
        assert tops == sorted(tops)
        for each in order[:4]:
            expect(each).to_be_in_viewport(ratio=1)
        # What is only read out is not seen, nor lies over a choice.
        for unseen in ("#person-title", "#weight-note"):
            expect(page.locator(unseen)).not_to_be_in_viewport()
        # Turned to its side, the phone is as a desk: the same person, beside the picture.
        page.get_by_role("radio", name="Male", exact=True).tap()
        page.set_viewport_size(LYING_PHONE["viewport"])
        chosen = page.locator(".panel").get_by_role("radio", name="Male", exact=True)
        expect(chosen).to_be_checked()


@pytest.mark.parametrize("device", [PHONE, SMALL_PHONE], ids=["phone", "small phone"])
def test_what_each_point_is_can_be_read_whole_above_the_picture(
    browser: Browser, service: httpx.Client, device: dict[str, Any]
):
    with Visitor.at(browser, str(service.base_url), device) as visitor:
        page = visitor.page
        # Without a detector all points are clicked.
        refused = {"status": 404, "content_type": "application/problem+json"}
        page.route(
            "**/v1/points", lambda route: route.fulfill(**refused, body=json.dumps(NOT_INSTALLED))
        )
        page.locator(".drop input[type=file]").set_input_files(FOLDER / "sample.jpg")
        visitor.wait_for_stage()
        page.locator(".next-line.is-guided").wait_for()
        visitor.stage.focus()
        heights = set()
        for _ in range(24):
            assert not page.evaluate(GUIDE_IS_CUT)
            heights.add(page.locator(".next-line").bounding_box()["height"])
            page.keyboard.press("s")
        assert len(heights) == 1
        expect(page.locator(".next-line.is-guided")).not_to_be_attached()


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_axe_finds_nothing_serious_in_a_full_screen(
    browser: Browser, service: httpx.Client, axe: str, scheme: str
):
    settled = {"color_scheme": scheme}
    with Visitor.at(browser, str(service.base_url), PHONE, **settled) as visitor:
        page = visitor.page
        visitor.open_sample()
        page.get_by_role("button", name="Fill the screen").tap()
        visitor.wait_for_whole_picture()
        visitor.click_points(LIMBS, touch=True)
        assert serious_findings(page, axe) == []
        assert not page.evaluate("document.documentElement.scrollWidth > innerWidth")
