"""What is wrong with a picture that is to be measured is told where the picture lies."""

import io
from pathlib import Path

import httpx
import pytest
from PIL import Image
from playwright.sync_api import Browser, Locator, Page, expect

from service.demo_data import sample
from tests.e2e.page.test_for_everyone import axe, serious_findings
from tests.e2e.page.visitor import PHONE, Visitor
from tests.e2e.service import ended_job

__all__ = ("axe",)

DATA = Path(sample.__file__).parent
FRONT = (DATA / "front.jpg").read_bytes()


def jpeg(picture: Image.Image) -> bytes:
    written = io.BytesIO()
    picture.save(written, "JPEG", quality=92)
    return written.getvalue()


def truncated() -> bytes:
    return FRONT[: len(FRONT) // 2]


def tiny() -> bytes:
    return jpeg(Image.open(io.BytesIO(FRONT)).resize((20, 27)))


def nobody() -> bytes:
    """The wall beside the person."""
    return jpeg(Image.open(io.BytesIO(FRONT)).crop((0, 0, 200, 480)).resize((720, 960)))


def several() -> bytes:
    person = Image.open(io.BytesIO(FRONT))
    pair = Image.new("RGB", (2 * person.width, person.height))
    pair.paste(person, (0, 0))
    pair.paste(person, (person.width, 0))
    return jpeg(pair)


def place(page: Page, name: str) -> Locator:
    return page.locator(f'[data-place="{name}"]')


def choose(page: Page, name: str, content: bytes) -> None:
    chosen = place(page, name).locator("input[type=file]")
    chosen.set_input_files({"name": "p.jpg", "mimeType": "image/jpeg", "buffer": content})


def uploaded(service: httpx.Client, content: bytes) -> str:
    return service.post("/v1/images", files={"image": content}).raise_for_status().json()["id"]


@pytest.mark.parametrize(
    ("content", "told"),
    [
        (truncated, "p.jpg is cut off"),
        (tiny, "p.jpg has 20 × 27 pixels; at least 64"),
        (nobody, "Nobody was found in this picture"),
        (several, "This one shows several"),
        (lambda: FRONT, "turn by a quarter for the side"),
    ],
    ids=["truncated", "tiny", "nobody", "several", "from another side"],
)
def test_an_error_of_a_picture_is_told_at_its_place_alone(
    browser: Browser, service: httpx.Client, axe: str, content, told: str
):
    with Visitor.at(browser, str(service.base_url), PHONE) as visitor:
        page = visitor.page
        page.get_by_role("link", name="Measure", exact=True).tap()
        choose(page, "front", FRONT)
        choose(page, "side", content())
        expect(place(page, "side").locator(".note", has_text=told)).to_be_visible()
        expect(place(page, "front")).to_contain_text("Good to measure")
        assert place(page, "front").locator(".note").count() == 0
        assert serious_findings(page, axe) == []


def test_a_file_that_is_no_picture_leaves_the_one_before(visitor: Visitor):
    page = visitor.page
    page.get_by_role("link", name="Measure", exact=True).click()
    choose(page, "front", FRONT)
    expect(place(page, "front")).to_contain_text("Good to measure")
    choose(page, "front", b"no picture")
    expect(place(page, "front").get_by_role("alert")).to_contain_text("not a picture")
    expect(place(page, "front").get_by_alt_text("The front picture")).to_be_visible()


def test_a_picture_that_cannot_be_measured_is_asked_for_again(visitor: Visitor):
    page = visitor.page
    page.get_by_role("link", name="Measure", exact=True).click()
    page.get_by_role("radio", name="Female", exact=True).check()
    page.get_by_label("Height", exact=True).fill("155.5")
    choose(page, "front", FRONT)
    choose(page, "side", tiny())
    expect(place(page, "side").get_by_role("alert")).to_contain_text("20 × 27 pixels")
    expect(page.get_by_role("button", name="Add the side picture")).to_be_disabled()
    choose(page, "side", (DATA / "side.jpg").read_bytes())
    expect(page.get_by_role("button", name="Measure", exact=True)).to_be_enabled()


def test_a_failed_scan_that_began_with_the_side_is_opened_again_in_its_places(
    browser: Browser, service: httpx.Client, axe: str
):
    asked = {
        "gender": "female",
        "height_m": 1.555,
        "views": [
            {"view": "side", "image_id": uploaded(service, nobody())},
            {"view": "front", "image_id": uploaded(service, FRONT)},
        ],
    }
    scan = ended_job(service, service.post("/v1/scans", json=asked))
    assert scan["problem"]["field"] == "views.0.points"
    with Visitor.at(browser, str(service.base_url), PHONE) as visitor:
        page = visitor.page
        page.goto(f"{visitor.origin}/#/scans/{scan['id']}")
        expect(page.get_by_role("heading", name="Nobody could be measured")).to_be_visible()
        first = page.locator(".ended-pictures li").first
        expect(first).to_contain_text("Nobody was found in this picture")
        assert serious_findings(page, axe) == []
        page.get_by_role("button", name="Change the pictures and measure again").tap()
        expect(place(page, "side")).to_contain_text("Nobody was found in this picture")
        expect(place(page, "front")).to_contain_text("Good to measure")
        assert place(page, "front").get_by_role("alert").count() == 0
