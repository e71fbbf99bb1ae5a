"""Placing points by mouse, by keys, on phones; taking back what went wrong."""

import json
from typing import Any

import httpx
import pytest
from playwright.sync_api import Browser, expect

from service.demo_data.sample import FOLDER
from tests.e2e.page.test_proposals import NOT_INSTALLED
from tests.e2e.page.visitor import (
    DESK,
    LIMBS,
    PHONE,
    SAMPLE_POINTS,
    SAMPLE_SIZE,
    Visitor,
    serious_findings,
)


@pytest.fixture
def clicking(visitor: Visitor) -> Visitor:
    visitor.open_sample()
    visitor.describe_person()
    return visitor


def test_points_are_asked_for_one_after_the_other_and_the_body_follows(clicking: Visitor):
    page = clicking.page
    expect(page.locator(".next-name")).to_have_text("Left shoulder")
    clicking.click_points(LIMBS[:6])
    expect(page.locator(".next-name")).to_have_text("Left hip")
    outline = page.locator(".live-outline")
    expect(outline).to_be_attached()
    before = outline.get_attribute("d")
    page.mouse.click(*clicking.on_stage(380, 466))
    expect(outline).not_to_have_attribute("d", before or "")


def test_a_point_is_dragged_only_by_a_real_movement_and_nudged_by_keys(clicking: Visitor):
    page = clicking.page
    clicking.click_points(LIMBS[:2])
    x, y = clicking.place_of("left_shoulder")
    at = clicking.on_stage(438.3, 220.5)
    # A press that hardly moves, near a point, places the next one and leaves that one alone.
    page.mouse.move(at[0] + 2, at[1])
    page.mouse.down()
    page.mouse.move(at[0] + 4, at[1])
    page.mouse.up()
    expect(clicking.points()).to_have_count(3)
    assert clicking.place_of("left_shoulder") == (x, y)

    other = clicking.on_stage(251.4, 225.2)
    before = clicking.place_of("right_shoulder")
    page.mouse.move(*other)
    page.mouse.down()
    page.mouse.move(other[0] + 30, other[1] + 10, steps=4)
    page.mouse.up()
    dragged = (before[0] + 30, before[1] + 10)
    clicking.wait_for_place("right_shoulder", dragged, within_px=2.0)
    expect(clicking.points()).to_have_count(3)
    after = clicking.place_of("right_shoulder")
    page.keyboard.press("Shift+ArrowLeft")
    # Ten pixels of the picture.
    shown_px = page.locator(".stage-picture").bounding_box()["width"]
    nudged = (after[0] - 10.0 * shown_px / SAMPLE_SIZE[0], after[1])
    clicking.wait_for_place("right_shoulder", nudged, within_px=0.01)
    page.keyboard.press("Control+z")
    page.keyboard.press("Control+z")
    clicking.wait_for_place("right_shoulder", before, within_px=0.01)


def test_points_can_be_skipped_hidden_removed_and_swapped(clicking: Visitor):
    page = clicking.page
    page.get_by_role("button", name="Skip", exact=True).click()
    expect(page.locator(".next-name")).to_have_text("Right shoulder")
    page.mouse.click(*clicking.on_stage(251.4, 225.2))
    page.keyboard.press("h")
    expect(page.locator('[data-point="right_shoulder"] .is-hidden')).to_be_attached()
    page.get_by_role("button", name="Swap left and right").click()
    expect(page.locator('[data-point="left_shoulder"] .is-hidden')).to_be_attached()
    page.get_by_text("All points").click()
    page.get_by_role("button", name="Remove Left shoulder").click()
    expect(clicking.points()).to_have_count(0)


def test_all_of_it_works_without_a_mouse(clicking: Visitor):
    page = clicking.page
    clicking.stage.focus()
    for _ in range(3):
        page.keyboard.press("Shift+ArrowUp")
    page.keyboard.press("Enter")
    expect(clicking.points()).to_have_count(1)
    expect(page.locator(".loupe")).to_be_visible()
    page.keyboard.press("s")
    expect(page.locator(".next-name")).to_have_text("Left elbow")
    picture = page.locator(".stage-picture")
    width = picture.bounding_box()["width"]
    page.keyboard.press("+")
    clicking.wait_for_width(picture, 1.2 * width)
    page.keyboard.press("0")
    clicking.wait_for_width(picture, width - 0.5, width + 0.5)


def test_the_picture_zooms_about_the_pointer_and_pans(clicking: Visitor):
    page = clicking.page
    at = clicking.on_stage(350, 480)
    whole = page.locator(".stage-picture").bounding_box()
    page.mouse.move(*at)
    for _ in range(6):
        page.mouse.wheel(0, -200)
    # Six times exp(0.3).
    picture = page.locator(".stage-picture")
    clicking.wait_for_width(picture, 5.9 * whole["width"])
    wide = picture.bounding_box()
    page.mouse.click(*at)
    box = clicking.stage.bounding_box()
    clicking.wait_for_place("left_shoulder", (at[0] - box["x"], at[1] - box["y"]), within_px=1.0)
    page.mouse.move(at[0] + 80, at[1] + 80)
    page.mouse.down()
    page.mouse.move(at[0] + 140, at[1] + 120, steps=5)
    page.mouse.up()
    page.wait_for_function(
        "([picture, x]) => Math.abs(picture.getBoundingClientRect().x - x) <= 3",
        arg=[picture.element_handle(), wide["x"] + 60],
    )
    expect(clicking.points()).to_have_count(1)


SMALL_PHONE = PHONE | {"viewport": {"width": 360, "height": 640}}
LYING_PHONE = PHONE | {"viewport": {"width": 844, "height": 390}}
DEVICES = {"desk": DESK, "small phone": SMALL_PHONE, "lying phone": LYING_PHONE}

LIES_ON_STAGE = """([x, y]) => document.elementFromPoint(x, y)?.closest(".stage") !== null"""
FOCUSED_LABEL = "document.activeElement.getAttribute('aria-label')"
GUIDE_IS_CUT = """() => {
  const line = document.querySelector(".next-line.is-guided");
  return line.scrollHeight > line.clientHeight || line.scrollWidth > line.clientWidth;
}"""


@pytest.mark.parametrize("device", DEVICES.values(), ids=list(DEVICES))
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


@pytest.mark.parametrize("device", [SMALL_PHONE, LYING_PHONE])
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


def test_what_each_point_is_can_be_read_whole_above_the_picture(
    browser: Browser, service: httpx.Client
):
    with Visitor.at(browser, str(service.base_url), SMALL_PHONE) as visitor:
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


def test_axe_finds_nothing_serious_in_a_full_screen(
    browser: Browser, service: httpx.Client, axe: str
):
    with Visitor.at(browser, str(service.base_url), PHONE, color_scheme="dark") as visitor:
        page = visitor.page
        visitor.open_sample()
        page.get_by_role("button", name="Fill the screen").tap()
        visitor.wait_for_whole_picture()
        visitor.click_points(LIMBS, touch=True)
        assert serious_findings(page, axe) == []
        assert not page.evaluate("document.documentElement.scrollWidth > innerWidth")
