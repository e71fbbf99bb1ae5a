"""Placing points: by mouse, by keys; taking back what went wrong."""

import pytest
from playwright.sync_api import expect

from tests.e2e.page.visitor import LIMBS, SAMPLE_SIZE, Visitor


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


def test_what_was_done_can_be_undone_and_done_again(clicking: Visitor):
    page = clicking.page
    clicking.click_points(LIMBS[:3])
    page.keyboard.press("Control+z")
    expect(clicking.points()).to_have_count(2)
    expect(page.locator(".next-name")).to_have_text("Left elbow")
    page.keyboard.press("Control+Shift+z")
    expect(clicking.points()).to_have_count(3)
    page.get_by_role("button", name="Undo").click()
    expect(clicking.points()).to_have_count(2)


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
