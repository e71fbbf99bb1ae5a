"""Proposed points: from a dropped picture to a fit by four taps, and what somebody says of them."""

import base64
import io
import json
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import httpx
import pytest
from PIL import Image
from playwright.sync_api import Browser, Route, expect

from tests.accuracy.files import PICTURES_FOLDER
from tests.e2e.page.visitor import DESK, PHONE, Visitor, serious_findings

WOMAN = PICTURES_FOLDER / "woman_middle_aged_middling_standing.jpg"
MAN = PICTURES_FOLDER / "man_middle_aged_middling_standing.jpg"
MOST_TAPS = 4

COUNT_TAPS = """
window.taps = 0;
addEventListener("pointerdown", () => window.taps++, true);
"""
DROP = """([selector, base64]) => {
  const bytes = Uint8Array.from(atob(base64), (each) => each.charCodeAt(0));
  const dataTransfer = new DataTransfer();
  dataTransfer.items.add(new File([bytes], "dropped.jpg", { type: "image/jpeg" }));
  document.querySelector(selector).dispatchEvent(
    new DragEvent("drop", { dataTransfer, bubbles: true, cancelable: true }));
}"""
NOT_INSTALLED = {
    "type": "/problems/not-found",
    "title": "There is no such thing",
    "status": 404,
    "detail": "The detector that proposes points is not installed in this service.",
    "code": "detector-not-installed",
    "remedy": "Click the points.",
    "errors": [],
}


def drop(visitor: Visitor, picture: bytes, *, on: str = ".drop") -> None:
    # The load event does not await the page's modules.
    expect(visitor.page.locator(on)).to_be_visible()
    visitor.page.evaluate(DROP, [on, base64.b64encode(picture).decode()])
    visitor.wait_for_stage()


def side_by_side(*pictures: Path) -> bytes:
    opened = [Image.open(each) for each in pictures]
    width, height = opened[0].size
    both = Image.new("RGB", (width * len(opened), height))
    for i, each in enumerate(opened):
        both.paste(each, (i * width, 0))
    written = io.BytesIO()
    both.save(written, "JPEG", quality=92)
    return written.getvalue()


def doubting(*names: str) -> Callable[[Route], None]:
    """The real answer, with points of these names in doubt."""

    def answer(route: Route) -> None:
        response = route.fetch()
        found: dict[str, Any] = response.json()
        for name in names:
            found["points"][name] |= {"visibility": 1, "confidence": 0.3}
        route.fulfill(response=response, json=found | {"doubtful": list(names)})

    return answer


@pytest.mark.parametrize("device", [DESK, PHONE], ids=["desk", "phone"])
def test_a_dropped_picture_becomes_a_body_by_four_taps(
    browser: Browser, service: httpx.Client, device: dict[str, Any]
):
    with Visitor.at(browser, str(service.base_url), device) as visitor:
        page = visitor.page
        drop(visitor, WOMAN.read_bytes())
        expect(visitor.points()).to_have_count(21)
        page.evaluate(COUNT_TAPS)
        page.get_by_role("radio", name="Female", exact=True).check()
        height = page.get_by_label("Height", exact=True)
        height.click()
        page.keyboard.type("168")
        expect(page.locator(".live-outline")).to_be_attached()
        sent = visitor.sent_view()
        taps = page.evaluate("window.taps")
        assert taps <= MOST_TAPS
        assert {each["source"] for each in sent["points"].values()} == {"proposal"}
        visitor.wait_for_result()
        visitor.wait_until_drawn(placement="canonical")
        expect(page.get_by_role("row", name=re.compile("^Height"))).to_contain_text("168")
        page.locator(".more-notes > summary").click()
        # Counted, not named.
        expect(page.get_by_text("21 points were found automatically")).to_be_visible()


def test_a_point_that_is_dragged_is_a_click_and_undoing_makes_it_a_proposal_again(
    visitor: Visitor,
):
    page = visitor.page
    drop(visitor, WOMAN.read_bytes())
    visitor.correct()
    ring = page.locator('[data-point="left_wrist"] .is-proposed')
    expect(ring).to_be_attached()
    x, y = visitor.place_of("left_wrist")
    box = visitor.stage.bounding_box()
    assert box is not None
    page.mouse.move(box["x"] + x, box["y"] + y)
    page.mouse.down()
    page.mouse.move(box["x"] + x + 12, box["y"] + y + 9, steps=3)
    page.mouse.up()
    expect(ring).not_to_be_attached()
    expect(page.get_by_text("20 of 21 proposed")).to_be_visible()
    page.keyboard.press("Control+z")
    expect(ring).to_be_attached()
    page.keyboard.press("Control+Shift+z")
    visitor.describe_person()
    points = visitor.sent_view()["points"]
    assert "source" not in points.pop("left_wrist")
    assert {each["source"] for each in points.values()} == {"proposal"}


def test_doubtful_points_are_asked_about_and_nothing_waits_for_the_answers(visitor: Visitor):
    page = visitor.page
    asked = ("left_ankle", "right_wrist", "left_knee", "right_toe", "nose")
    page.route("**/v1/points", doubting(*asked))
    drop(visitor, WOMAN.read_bytes())
    visitor.correct()
    question = page.locator(".next-name")
    expect(question).to_have_text("Is this the left ankle?")
    visitor.describe_person()
    expect(page.get_by_role("button", name="Measure", exact=True)).to_be_enabled()
    page.get_by_role("button", name="Yes").click()
    expect(question).to_have_text("Is this the right wrist?")
    page.get_by_role("button", name="It is hidden").click()
    expect(question).to_have_text("Is this the left knee?")
    page.get_by_role("button", name="Move it").click()
    expect(page.locator(".next-kicker")).to_have_text("Click where it is")
    expect(visitor.stage).to_be_focused()
    page.keyboard.press("ArrowLeft")
    expect(question).to_have_text("Are these the right toes?")
    page.get_by_role("button", name="Leave out").click()
    expect(question).to_have_text("Is this the nose?")
    # What was answered last is asked again.
    page.keyboard.press("Control+z")
    expect(question).to_have_text("Are these the right toes?")
    page.get_by_role("button", name="Leave out").click()
    points = visitor.sent_view()["points"]
    assert "right_toe" not in points
    said = {name: (points[name]["visibility"], points[name].get("source")) for name in asked[:3]}
    assert said["left_ankle"] == (2, None)
    assert said["right_wrist"] == (1, "proposal")
    assert said["left_knee"][1] is None
    assert points["nose"]["source"] == "proposal"


def test_clicking_is_one_tap_away_and_so_is_proposing(visitor: Visitor):
    page = visitor.page
    drop(visitor, WOMAN.read_bytes())
    expect(visitor.points()).to_have_count(21)
    visitor.correct()
    page.locator(".panel").get_by_role("button", name="Place points by hand").click()
    expect(visitor.points()).to_have_count(0)
    expect(page.locator(".next-name")).to_have_text("Left shoulder")
    page.get_by_role("button", name="Propose points").click()
    expect(visitor.points()).to_have_count(21)
    page.keyboard.press("Control+z")
    page.keyboard.press("Control+z")
    expect(visitor.points()).to_have_count(21)
    page.keyboard.press("Control+z")
    expect(visitor.points()).to_have_count(0)


def test_that_nobody_is_there_is_said_and_points_are_asked_for(visitor: Visitor):
    page = visitor.page
    plain = io.BytesIO()
    Image.new("RGB", (640, 480), (120, 90, 60)).save(plain, "JPEG")
    drop(visitor, plain.getvalue())
    expect(page.locator(".stage-word")).to_contain_text("Nobody was found")
    expect(page.get_by_role("status").filter(has_text="Nobody was found")).to_be_attached()
    expect(page.get_by_label("Choose another picture")).to_be_attached()
    page.get_by_role("button", name="Place points by hand").click()
    expect(page.locator(".next-name")).to_have_text("Left shoulder")
    box = visitor.stage.bounding_box()
    assert box is not None
    page.mouse.click(box["x"] + box["width"] / 2, box["y"] + box["height"] / 2)
    expect(visitor.points()).to_have_count(1)
    expect(page.locator(".stage-word")).not_to_be_attached()


def test_of_two_people_the_one_tapped_on_is_meant(visitor: Visitor):
    page = visitor.page
    drop(visitor, side_by_side(WOMAN, MAN))
    boxes = page.locator("[data-person]")
    expect(boxes).to_have_count(2)
    visitor.correct()
    chosen = page.locator(".person-box.is-chosen")
    other = page.locator(".person-box:not(.is-chosen)")
    first, second = (each.get_attribute("data-person") for each in (chosen, other))
    before = visitor.place_of("left_hip")
    box = other.locator(".person-line").bounding_box()
    assert box is not None
    page.mouse.click(box["x"] + box["width"] / 2, box["y"] + box["height"] / 2)
    expect(chosen).to_have_attribute("data-person", second or "")
    assert abs(visitor.place_of("left_hip")[0] - before[0]) > box["width"]
    # The same without a pointer.
    button = page.get_by_role("button", name=f"Person {int(first or 0) + 1}")
    button.focus()
    page.keyboard.press("Enter")
    expect(chosen).to_have_attribute("data-person", first or "")
    visitor.wait_for_place("left_hip", before, within_px=0.5)


def test_without_a_detector_all_is_as_without_proposals(visitor: Visitor):
    page = visitor.page
    asked: list[str] = []

    def refuse(route: Route) -> None:
        asked.append(route.request.url)
        route.fulfill(
            status=404, content_type="application/problem+json", body=json.dumps(NOT_INSTALLED)
        )

    page.route("**/v1/points", refuse)
    with page.expect_response("**/v1/points"):
        drop(visitor, WOMAN.read_bytes())
    expect(page.locator(".next-name")).to_have_text("Left shoulder")
    expect(page.get_by_role("button", name="Propose points")).not_to_be_attached()
    expect(page.get_by_role("alert")).not_to_be_attached()
    with page.expect_response("**/v1/images"):
        drop(visitor, MAN.read_bytes(), on=".bench")
    expect(page.get_by_role("button", name="Propose points")).not_to_be_attached()
    assert len(asked) == 1


def test_axe_finds_nothing_serious_in_questions_and_people(
    browser: Browser, service: httpx.Client, axe: str
):
    with Visitor.at(browser, str(service.base_url), PHONE, color_scheme="dark") as visitor:
        page = visitor.page
        page.route("**/v1/points", doubting("left_ankle"))
        drop(visitor, side_by_side(WOMAN, MAN))
        expect(page.locator("[data-person]")).to_have_count(2)
        assert serious_findings(page, axe) == []
        visitor.correct()
        expect(page.get_by_role("group", name="Is this the left ankle?")).to_be_visible()
        assert serious_findings(page, axe) == []
        assert not page.evaluate("document.documentElement.scrollWidth > innerWidth")
        page.get_by_role("button", name="Yes").click()
        expect(page.get_by_role("button", name="Place points by hand").first).to_be_visible()
        assert serious_findings(page, axe) == []
