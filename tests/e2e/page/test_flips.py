"""Limbs of a result are turned the other way: seen at once, and then fitted again."""

import re

import numpy as np
from playwright.sync_api import Page, Request, expect

from tests.e2e.page.test_result import as_if, open_fit
from tests.e2e.page.visitor import SAMPLE_POINTS, SAMPLE_SIZE, Visitor, serious_findings

OTHER = {"toward": "away", "away": "toward"}
SAYS = {"toward": "toward you", "away": "away from you"}


def facings(visitor: Visitor, fit: str) -> dict[str, str]:
    result = visitor.page.request.get(f"{visitor.origin}/v1/fits/{fit}/result").json()
    return {each["limb"]: each["facing"] for each in result["views"][0]["limb_facing"]}


def on_forearm(visitor: Visitor, side: str) -> tuple[float, float]:
    """Within the canvas, where the sample's forearm is seen."""
    points = SAMPLE_POINTS
    ends = [points[f"{side}_{joint}"] for joint in ("elbow", "wrist")]
    box = visitor.body.bounding_box()
    assert box is not None
    x, y = (sum(end[axis] for end in ends) / 2 for axis in ("x", "y"))
    return x / SAMPLE_SIZE[0] * box["width"], y / SAMPLE_SIZE[1] * box["height"]


def sent_again(page: Page) -> Request:
    with page.expect_request(
        lambda request: request.method == "POST" and request.url.endswith("/v1/fits")
    ) as sent:
        page.get_by_role("button", name="Measure again", exact=True).click()
    return sent.value


def limb(page: Page, name: str):
    return page.get_by_role("button", name=re.compile(f"^{name} "))


def test_a_limb_that_is_clicked_is_seen_turned_and_fitted_again(
    visitor: Visitor, finished_fit: str
):
    # The right one: the left lies nearly in the picture, and turned looks the same from the side.
    open_fit(visitor, finished_fit)
    page = visitor.page
    visitor.choose("Photo")
    was = facings(visitor, finished_fit)["right_forearm"]
    wanted = OTHER[was]
    x, y = on_forearm(visitor, "right")
    expect(visitor.body).to_have_attribute("data-limbs", "none")
    before = visitor.pixels(visitor.body)
    beside = page.get_by_role("img", name="The body from the side")
    side = visitor.pixels(beside)
    visitor.body.hover(position={"x": x, "y": y})
    expect(visitor.body).to_have_attribute("data-limbs", "right_forearm")
    expect(page.locator(".look-limb")).to_contain_text(f"Right forearm: points {SAYS[was]}")
    expect(limb(page, "Right forearm")).to_have_count(0)
    visitor.body.click(position={"x": x, "y": y})
    expect(visitor.body).to_have_attribute("data-limbs", f"right_forearm right_forearm {wanted}")
    expect(limb(page, "Right forearm")).to_have_attribute("aria-pressed", "true")
    expect(limb(page, "Right forearm")).to_contain_text(f"now {SAYS[wanted]}")
    expect(page.get_by_text("Preview, not measured yet")).to_be_visible()
    expect(page.get_by_text("still those from before").first).to_be_visible()
    page.get_by_role("heading", name="The body", exact=True).hover()
    changed = np.abs(visitor.pixels(visitor.body) - before).max(axis=2) > 12
    height, width = changed.shape
    # The forearm looks otherwise; the legs do not.
    box = visitor.body.bounding_box()
    row, column = int(y / box["height"] * height), int(x / box["width"] * width)
    assert changed[row - 20 : row + 20, column - 20 : column + 20].mean() > 0.1
    assert changed[int(0.7 * height) :].mean() < 0.002
    visitor.wait_for_change(beside, side, share=0.004)
    assert sent_again(page).post_data_json["views"][0]["limb_facing"] == {"right_forearm": wanted}
    page.wait_for_function("was => !location.hash.endsWith(was)", arg=finished_fit)
    visitor.wait_for_result()
    fresh = page.locator("[data-fit]").get_attribute("data-fit")
    assert facings(visitor, fresh)["right_forearm"] == wanted
    page.get_by_role("button", name=re.compile("^History")).click()
    for fit in (finished_fit, fresh):
        expect(page.locator(f'a[href="#/fits/{fit}"]')).to_be_visible()


def test_a_preview_is_taken_back_and_turned_bodies_take_clicks_too(
    visitor: Visitor, finished_fit: str
):
    open_fit(visitor, finished_fit)
    page = visitor.page
    visitor.unfold_for_experts()
    visitor.choose("As in the picture")
    expect(visitor.body).to_have_attribute("data-limbs", "none")
    page.get_by_role("button", name="From the side", exact=True).click()
    before = visitor.wait_until_drawn(placement="turned")
    box = visitor.body.bounding_box()
    # A thigh, from the side; a drag turns the body and flips nothing.
    at = {"x": box["width"] / 2, "y": 0.62 * box["height"]}
    visitor.body.click(position=at)
    expect(visitor.body).to_have_attribute("data-limbs", re.compile("thigh (toward|away)$"))
    page.get_by_role("button", name="Take back").click()
    expect(visitor.body).to_have_attribute("data-limbs", "none")
    expect(page.get_by_text("Preview, not measured yet")).to_have_count(0)
    expect(page.get_by_role("button", name="Adjust", exact=True)).to_be_visible()
    assert (np.abs(visitor.pixels(visitor.body) - before).max(axis=2) > 12).mean() < 0.002
    middle = box["x"] + at["x"], box["y"] + at["y"]
    page.mouse.move(*middle)
    page.mouse.down()
    page.mouse.move(middle[0] + 60, middle[1])
    page.mouse.up()
    visitor.wait_for_change(visitor.body, before, share=0.01)
    expect(page.get_by_text("Preview, not measured yet")).to_have_count(0)


def test_the_warning_leads_to_its_limb_and_keys_do_all_of_it(
    visitor: Visitor, finished_fit: str, axe: str
):
    found = facings(visitor, finished_fit)
    doubted = [
        {
            "limb": name,
            "facing": facing,
            "source": "energy",
            "ambiguous": name == "right_shin",
            "alternative_nats": None,
        }
        for name, facing in found.items()
    ]
    warning = {"code": "ambiguous-limb-facing", "severity": "warns", "reason": "", "remedy": ""}
    as_if(visitor, {"limb_facing": doubted, "warnings": [warning | {"where": []}]})
    open_fit(visitor, finished_fit)
    page = visitor.page
    page.get_by_role("button", name="If you see which, say so").press("Enter")
    shin = limb(page, "Right lower leg")
    expect(shin).to_be_focused()
    expect(shin).to_be_in_viewport()
    expect(shin).to_contain_text("uncertain")
    expect(visitor.body).to_have_attribute("data-limbs", "right_shin")
    page.keyboard.press("Tab")
    expect(visitor.body).not_to_have_attribute("data-limbs", "right_shin")
    page.keyboard.press("Shift+Tab")
    page.keyboard.press("Enter")
    wanted = OTHER[found["right_shin"]]
    expect(visitor.body).to_have_attribute("data-limbs", f"right_shin right_shin {wanted}")
    expect(page.locator("#page > p[role=status]")).to_contain_text("Preview: right lower leg")
    assert serious_findings(page, axe) == []
    page.keyboard.press("Enter")
    expect(visitor.body).to_have_attribute("data-limbs", "right_shin")
    page.keyboard.press("Enter")
    again = page.get_by_role("button", name="Measure again", exact=True)
    for _ in range(60):
        page.keyboard.press("Tab")
        if again.evaluate("each => each === document.activeElement"):
            break
    with page.expect_request(
        lambda request: request.method == "POST" and request.url.endswith("/v1/fits")
    ) as sent:
        page.keyboard.press("Enter")
    assert sent.value.post_data_json["views"][0]["limb_facing"] == {"right_shin": wanted}
    visitor.wait_for_result()
