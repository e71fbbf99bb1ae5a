"""Front and side in one fit: from the sample pair to the result of each picture."""

import re

import httpx
import pytest
from playwright.sync_api import Browser, expect

from service.demo_data.sample import FOLDER
from tests.e2e.page.visitor import PHONE, Visitor, serious_findings
from tests.e2e.service import ended_job


@pytest.fixture(scope="module")
def pair(service: httpx.Client) -> dict:
    """A finished fit of two pictures."""
    views = []
    for name in ("front", "side"):
        content = (FOLDER / f"{name}.jpg").read_bytes()
        image = service.post("/v1/images", files={"image": content}).raise_for_status().json()
        views.append({"view": name, "image_id": image["id"]})
    asked = {"gender": "female", "height_m": 1.555, "views": views}
    ended = ended_job(service, service.post("/v1/fits", json=asked))
    assert ended["state"] == "succeeded"
    return ended


def open_pair(visitor: Visitor, pair: dict) -> None:
    visitor.page.goto(f"{visitor.origin}/#/fits/{pair['id']}")
    expect(visitor.page.locator('[data-fit][aria-busy="false"]')).to_be_attached()


def test_the_sample_pair_is_measured_in_two_taps(browser: Browser, service: httpx.Client, axe: str):
    with Visitor.at(browser, str(service.base_url), PHONE | {"color_scheme": "dark"}) as visitor:
        page = visitor.page
        page.get_by_role("button", name="Front and side").tap()
        visitor.wait_for_stage()
        expect(page.get_by_role("radio", name="Front", exact=True)).to_be_checked()
        assert serious_findings(page, axe) == []
        page.get_by_role("button", name="Measure", exact=True).tap()
        visitor.wait_for_result()
        visitor.wait_until_drawn(placement="canonical")
        row = page.get_by_role("row", name=re.compile("^Weight"))
        weight = float(re.search(r"Weight\s+([\d.]+)", row.inner_text())[1])
        assert 45.0 < weight < 65.0
        assert serious_findings(page, axe) == []
        assert not page.evaluate("document.documentElement.scrollWidth > innerWidth")


def test_a_side_picture_is_added_with_points_of_its_own_and_taken_away(visitor: Visitor):
    page = visitor.page
    visitor.open_sample(name="Upright", with_points=True)
    front = visitor.points().count()
    page.get_by_label("Add a picture from the side").set_input_files(FOLDER / "side.jpg")
    expect(page.get_by_role("radio", name="Side", exact=True).first).to_be_checked()
    visitor.wait_for_stage()
    expect(visitor.points().first).to_be_attached()
    visitor.correct()
    page.get_by_role("radio", name="Front", exact=True).first.check()
    expect(visitor.points()).to_have_count(front)
    page.get_by_role("radio", name="Side", exact=True).first.check()
    page.get_by_role("button", name="Remove", exact=True).click()
    expect(visitor.points()).to_have_count(front)
    assert len(visitor.sent_request()["views"]) == 1


def test_each_picture_shows_the_body_as_it_stands_there_and_says_how_well_it_fits(
    visitor: Visitor, pair: dict, axe: str
):
    page = visitor.page
    open_pair(visitor, pair)
    visitor.choose("Photo")
    front = visitor.wait_until_drawn(placement="picture")
    visitor.choose("Side")
    expect(page.locator('[data-fit][aria-busy="false"]')).to_be_attached()
    visitor.wait_for_change(visitor.body, front, share=0.02)
    visitor.unfold_for_experts()
    with page.expect_response(re.compile(r"/views/1/overlay\.png$")):
        page.get_by_label("Outline and edges of the body").check()
    experts = page.locator(".experts")
    experts.get_by_role("heading", name="For experts").click()
    for name in ("Front picture", "Side picture"):
        expect(experts.get_by_role("heading", name=name)).to_be_visible()
    expect(experts.get_by_text("Overlap with the silhouette")).to_have_count(2)
    assert serious_findings(page, axe) == []
    # Upright, one body is that of every picture.
    visitor.choose("Body")
    expect(page.get_by_role("radio", name="Side", exact=True)).to_have_count(0)


def test_one_picture_of_two_is_corrected_and_both_are_fitted_again(visitor: Visitor, pair: dict):
    page = visitor.page
    open_pair(visitor, pair)
    page.locator(".more-notes > summary").click()
    page.get_by_role("button", name="Adjust: Side picture").click()
    visitor.wait_for_stage()
    expect(page.get_by_role("radio", name="Side", exact=True).first).to_be_checked()
    expect(page.get_by_label("Height", exact=True)).to_have_value("155.5")
    page.get_by_label("Weight", exact=True).fill("54")
    asked = visitor.sent_request()
    assert asked["weight_kg"] == 54
    assert [each["view"] for each in asked["views"]] == ["front", "side"]
    visitor.wait_for_result()


def test_a_browser_that_opened_a_fit_by_its_link_knows_it(visitor: Visitor, pair: dict):
    open_pair(visitor, pair)
    visitor.page.get_by_role("button", name="History").click()
    expect(visitor.page.get_by_role("dialog")).to_contain_text("Woman, 155.5 cm")
