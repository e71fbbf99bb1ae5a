"""The result of several pictures: how they agree, each by itself, what is made of it, and again."""

import base64
import json
import re
from pathlib import Path

import httpx
import pytest
from playwright.sync_api import Browser, Route, expect

from service.demo_data import sample
from tests.e2e.page.test_for_everyone import axe, serious_findings
from tests.e2e.page.visitor import FIT_WITHIN_MS, PHONE, Visitor
from tests.e2e.service import ended_job

__all__ = ("axe",)

DATA = Path(sample.__file__).parent


@pytest.fixture(scope="module")
def scan(service: httpx.Client) -> dict:
    """A finished scan whose front picture came with a mask."""
    views = []
    for name in ("front", "side"):
        content = (DATA / f"scan_{name}.jpg").read_bytes()
        image = service.post("/v1/images", files={"image": content}).raise_for_status().json()
        views.append({"view": name, "image_id": image["id"]})
    asked = {"image_id": views[0]["image_id"], "mask": True}
    proposed = service.post("/v1/points", json=asked).raise_for_status().json()
    cut_out = base64.b64decode(proposed["mask"])
    mask = service.post("/v1/images", files={"image": cut_out}).raise_for_status().json()
    views[0]["mask_id"] = mask["id"]
    asked = {"gender": "female", "height_m": 1.555, "views": views}
    ended = ended_job(service, service.post("/v1/scans", json=asked))
    assert ended["state"] == "succeeded"
    return ended


def open_scan(visitor: Visitor, scan: dict) -> None:
    visitor.page.goto(f"{visitor.origin}/#/scans/{scan['id']}")
    expect(visitor.page.locator('[data-fit][aria-busy="false"]')).to_be_attached()


def test_it_says_how_the_pictures_agree_and_that_points_were_proposed(
    visitor: Visitor, scan: dict, service: httpx.Client
):
    page = visitor.page
    agreement = service.get(scan["links"]["result"]).raise_for_status().json()["agreement"]
    open_scan(visitor, scan)
    share = f"{100 * agreement:.0f}% of such pairs"
    if agreement >= 0.995:
        share = "agree very well"
    elif agreement < 0.1:
        share = "disagree"
    page.get_by_role("heading", name="For experts").click()
    expect(page.locator(".experts")).to_contain_text(share)
    expect(page.get_by_text("All points were found automatically")).to_be_visible()
    assert page.get_by_text("left ankle").count() == 0


def test_a_browser_that_opened_a_scan_by_its_link_knows_it(visitor: Visitor, scan: dict):
    open_scan(visitor, scan)
    visitor.page.get_by_role("button", name="Fits").click()
    expect(visitor.page.get_by_role("dialog")).to_contain_text("Woman, 155.5 cm")


def test_size_and_report_are_made_of_a_scan(
    browser: Browser, service: httpx.Client, axe: str, scan: dict
):
    with Visitor.at(browser, str(service.base_url), PHONE) as visitor:
        page = visitor.page
        open_scan(visitor, scan)
        page.get_by_role("button", name="Make the report").tap()
        made = page.locator(".derived")
        expect(made).to_contain_text("report.pdf", timeout=FIT_WITHIN_MS)
        page.get_by_role("radio", name="Clothing size").check()
        expect(page.get_by_role("button", name="Find the size")).to_be_disabled()
        page.get_by_role("radio", name="in, lb").check()
        expect(page.get_by_text("Charts are in cm, whichever units you chose")).to_be_visible()
        chart = {"S": ("76-82", "90-94"), "M": ("82-90", "95-103"), "L": ("90-98", "103-109")}
        for label, (chest, hip) in chart.items():
            page.get_by_label(f"{label}: Chest").fill(chest)
            page.get_by_label(f"{label}: Hip").fill(hip)
        page.get_by_role("button", name="Find the size").tap()
        expect(made).to_contain_text("Size M", timeout=FIT_WITHIN_MS)
        expect(made).to_contain_text("None fits")
        expect(made).to_contain_text(re.compile(r"Chest [\d.]+ ± [\d.]+ cm: within M \(82 to 90\)"))
        expect(made).to_contain_text("sizes.csv")
        assert serious_findings(page, axe) == []
        assert page.evaluate("document.documentElement.scrollWidth <= innerWidth")


def test_on_a_phone_a_measurement_is_shown_on_the_body(
    browser: Browser, service: httpx.Client, scan: dict
):
    with Visitor.at(browser, str(service.base_url), PHONE) as visitor:
        page = visitor.page
        open_scan(visitor, scan)
        page.get_by_role("button", name="Outseam").tap()
        expect(visitor.body).to_have_attribute("data-shows", "canonical clay SES outseam")
        expect(visitor.body).to_be_in_viewport(ratio=0.9)


def test_each_picture_shows_the_body_as_it_stands_there_and_says_how_well_it_fits(
    visitor: Visitor, scan: dict, axe: str
):
    page = visitor.page
    open_scan(visitor, scan)
    visitor.choose("Photo")
    front = visitor.wait_until_drawn(placement="picture")
    picture = page.get_by_alt_text("The picture")
    first = picture.get_attribute("src")
    visitor.choose("Side")
    expect(page.locator('[data-fit][aria-busy="false"]')).to_be_attached()
    visitor.wait_for_change(visitor.body, front, share=0.02)
    expect(picture).not_to_have_attribute("src", first or "")
    visitor.unfold_for_experts()
    with page.expect_response(re.compile(r"/overlay_1\.png$")):
        page.get_by_label("Outline and edges of the body").check()
    with page.expect_response(re.compile(r"/segmentation_1\.png$")):
        page.get_by_label("Silhouette of the picture").check()
    experts = page.locator(".experts")
    experts.get_by_role("heading", name="For experts").click()
    for name in ("The front picture", "The side picture"):
        expect(experts.get_by_role("heading", name=name)).to_be_visible()
    expect(experts.get_by_text("Overlap with the silhouette")).to_have_count(2)
    assert serious_findings(page, axe) == []
    # Upright, one body is that of every picture.
    visitor.choose("Body")
    expect(page.get_by_role("radio", name="Side", exact=True)).to_have_count(0)


def test_what_is_made_of_several_pictures_is_shown_on_the_stage(visitor: Visitor, scan: dict):
    page = visitor.page
    open_scan(visitor, scan)
    visitor.choose("Other pose")
    page.get_by_role("button", name="Make the other pose").click()
    turned = page.get_by_role("img", name="The body in this pose; arrow keys turn it")
    expect(turned).to_have_attribute("data-shows", "texture", timeout=FIT_WITHIN_MS)
    page.get_by_role("button", name="Back to the body").click()
    visitor.wait_until_drawn(placement="canonical")


def test_limbs_are_turned_in_each_picture_and_all_is_fitted_again(
    visitor: Visitor, scan: dict, axe: str
):
    page = visitor.page
    sent: list[dict] = []
    slants = [
        {
            "limb": "left_forearm",
            "facing": "away",
            "source": "energy",
            "ambiguous": True,
            "alternative_energy": None,
        }
    ]

    def slanted(route: Route) -> None:
        found = route.fetch()
        told = found.json()
        told["views"] = [view | {"limb_facing": slants} for view in told["views"]]
        route.fulfill(response=found, json=told)

    def keep(route: Route) -> None:
        sent.append(json.loads(route.request.post_data or "{}"))
        route.fulfill(status=202, json=scan)

    page.route(f"**{scan['links']['result']}*", slanted)
    page.route("**/v1/scans", keep)
    open_scan(visitor, scan)
    # The doubt about the side picture leads to it, and to the limb.
    side = page.locator('[data-view="1"]')
    side.get_by_role("button", name="If you see which, say so").click()
    expect(page.get_by_role("radio", name="Side", exact=True)).to_be_checked()
    forearm = page.locator("#limb-left_forearm")
    expect(forearm).to_be_focused()
    forearm.press("Enter")
    expect(page.get_by_text("Side picture: left forearm toward you").last).to_be_visible()
    visitor.choose("Front")
    expect(forearm).to_have_attribute("aria-pressed", "false")
    visitor.choose("Side")
    expect(forearm).to_have_attribute("aria-pressed", "true")
    assert serious_findings(page, axe) == []
    page.get_by_role("button", name="Fit again", exact=True).click()
    expect(page.get_by_role("button", name="Fit again", exact=True)).to_be_enabled()
    (asked,) = sent
    facings = [view.get("limb_facing") for view in asked["views"]]
    assert facings == [{}, {"left_forearm": "toward"}]
    assert [view["view"] for view in asked["views"]] == ["front", "side"]


def test_points_of_one_picture_are_corrected_and_all_are_measured_again(
    visitor: Visitor, scan: dict, service: httpx.Client
):
    page = visitor.page
    before = service.get(scan["links"]["request"]).raise_for_status().json()["views"]
    sent: list[dict] = []

    def keep(route: Route) -> None:
        sent.append(json.loads(route.request.post_data or "{}"))
        route.fulfill(status=202, json=scan)

    page.route("**/v1/scans", keep)
    open_scan(visitor, scan)
    side = page.locator('[data-view="1"]')
    if side.get_attribute("open") is None:
        side.get_by_role("heading", name="The side picture").click()
    side.get_by_role("button", name="Correct its points").click()
    visitor.wait_for_stage()
    expect(page.get_by_role("button", name="Fit the body")).to_be_enabled()
    # Whose picture it is outlives the page, as the rest of a draft does.
    page.reload()
    visitor.wait_for_stage()
    expect(page.get_by_text("One of several pictures")).to_be_visible()
    page.get_by_label("Height", exact=True).fill("156")
    page.get_by_role("button", name="Fit the body").click()
    expect(page).to_have_url(re.compile(r"#/scans/[0-9a-f-]{36}$"))
    (asked,) = sent
    assert asked["height_m"] == 1.56
    front, corrected = asked["views"]
    assert (front["view"], corrected["view"]) == ("front", "side")
    assert (front["points"], "mask_id" in front) == (before[0]["points"], True)
    assert "left_wrist" in corrected["points"]


def test_measuring_by_force_sends_the_masks_again(visitor: Visitor, scan: dict):
    page = visitor.page
    sent: list[dict] = []

    def withhold(route: Route) -> None:
        found = route.fetch()
        withheld = found.json() | {"verdict": "implausible", "measurements": []}
        route.fulfill(response=found, json=withheld)

    def keep(route: Route) -> None:
        sent.append(json.loads(route.request.post_data or "{}"))
        # Another scan would tell nothing more: this one is given again.
        route.fulfill(status=202, json=scan)

    page.route(f"**{scan['links']['result']}*", withhold)
    page.route("**/v1/scans", keep)
    open_scan(visitor, scan)
    page.get_by_role("button", name="Measure anyway").click()
    expect(page.get_by_role("button", name="Measure anyway")).to_be_enabled()
    (asked,) = sent
    assert asked["force"] is True
    front, side = asked["views"]
    assert front["mask_id"] not in {front["image_id"], side["image_id"]}
    assert "mask_id" not in side
