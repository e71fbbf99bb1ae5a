"""On a phone, by a screen reader, in the dark, with a key; what is announced, asked and shown."""

import subprocess
import sys
from pathlib import Path

import httpx
import pytest
from PIL import Image
from playwright.sync_api import Browser, expect

from fitter.vocabulary.remarks import Code
from tests.e2e.page.visitor import LIMBS, PHONE, Visitor, serious_findings
from tests.e2e.service import REPOSITORY, running_service, wait_for_estimator
from tests.illustrations.measuring_sheet import WITHOUT_EXAMPLE
from tests.readme import block


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_axe_finds_nothing_serious_from_start_to_result(
    browser: Browser, service: httpx.Client, axe: str, scheme: str, finished_fit: str
):
    with Visitor.at(browser, str(service.base_url), color_scheme=scheme) as visitor:
        page = visitor.page
        expect(page.locator("html")).to_have_attribute("data-theme", scheme)
        assert serious_findings(page, axe) == []
        visitor.open_sample()
        visitor.describe_person()
        visitor.click_points(LIMBS)
        page.get_by_text("All points").click()
        page.get_by_text("Known measurements").click()
        page.get_by_text("Keys and gestures").click()
        page.get_by_role("heading", name="Lens, shading and mask").click()
        expect(page.locator(".live-outline")).to_be_attached()
        assert serious_findings(page, axe) == []
        page.goto(f"{visitor.origin}/#/fits/{finished_fit}")
        visitor.wait_for_result()
        visitor.choose("In colour")
        for kind in ("Print", "Animation", "Other pose", "Texture", "Caricature", "Clothing size"):
            visitor.choose(kind)
            assert serious_findings(page, axe) == [], kind
        page.get_by_role("button", name="History").click()
        expect(page.get_by_role("dialog")).to_be_visible()
        assert serious_findings(page, axe) == []


def test_a_phone_stacks_the_page_and_takes_touches(
    browser: Browser, service: httpx.Client, finished_fit: str
):
    with Visitor.at(browser, str(service.base_url), PHONE) as visitor:
        page = visitor.page
        visitor.open_sample()
        stage, panel = visitor.stage.bounding_box(), page.locator(".panel").bounding_box()
        assert panel["y"] >= stage["y"] + stage["height"] - 1
        assert stage["width"] == pytest.approx(390, abs=1)
        visitor.click_points(LIMBS, touch=True)
        page.get_by_role("radio", name="Male", exact=True).tap()
        expect(page.locator(".live-outline")).to_be_attached()
        assert not page.evaluate("document.documentElement.scrollWidth > innerWidth")
        expect(page.get_by_role("button", name="Measure", exact=True)).to_be_in_viewport()
        page.goto(f"{visitor.origin}/#/fits/{finished_fit}")
        visitor.wait_for_result()
        assert not page.evaluate("document.documentElement.scrollWidth > innerWidth")


def test_a_finger_aims_with_a_loupe_and_places_where_it_is_lifted(
    browser: Browser, service: httpx.Client
):
    with Visitor.at(browser, str(service.base_url), PHONE) as visitor:
        visitor.open_sample()
        start, end = visitor.on_stage(300, 500), visitor.on_stage(360, 540)
        session = visitor.page.context.new_cdp_session(visitor.page)

        def touch(kind: str, *at: tuple[float, float]) -> None:
            points = [{"x": x, "y": y} for x, y in at]
            session.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": points})

        touch("touchStart", start)
        touch("touchMove", end)
        expect(visitor.page.locator(".loupe")).to_be_visible()
        touch("touchEnd")
        expect(visitor.points()).to_have_count(1)
        box = visitor.stage.bounding_box()
        lifted = (end[0] - box["x"], end[1] - box["y"])
        visitor.wait_for_place("left_shoulder", lifted, within_px=1.0)

        # Two fingers zoom and place nothing.
        picture = visitor.page.locator(".stage-picture")
        wide = picture.bounding_box()["width"]
        middle = box["y"] + box["height"] / 2
        touch("touchStart", (150, middle))
        touch("touchStart", (150, middle), (250, middle))
        for apart in (30, 60, 90):
            touch("touchMove", (150 - apart, middle), (250 + apart, middle))
        touch("touchEnd")
        visitor.wait_for_width(picture, 1.5 * wide)
        expect(visitor.points()).to_have_count(1)


def test_the_page_asks_for_the_key_the_service_wants(
    browser: Browser, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    monkeypatch.setenv("MAQUETTE_AUTHENTICATION", "keys")
    monkeypatch.setenv("MAQUETTE_DATA_DIR", str(tmp_path))
    with running_service(tmp_path) as client:
        made = subprocess.run(
            [sys.executable, "-m", "service.cli", "keys", "create", "visitor"],
            cwd=REPOSITORY,
            capture_output=True,
            text=True,
            check=True,
        )
        key = made.stdout.strip()
        client.headers["Authorization"] = f"Bearer {key}"
        wait_for_estimator(client)
        with Visitor.at(browser, str(client.base_url)) as visitor:
            page = visitor.page
            visitor.open_sample(with_points=True)
            dialog = page.get_by_role("dialog", name="This service asks for a key")
            expect(dialog).to_be_visible()
            page.get_by_label("API key").fill("mq_wrong")
            page.get_by_role("button", name="Use this key").click()
            expect(dialog).to_contain_text("unknown or revoked")
            page.get_by_label("API key").fill(key)
            page.get_by_role("button", name="Use this key").click()
            expect(dialog).to_be_hidden()
            expect(page.locator(".live-outline")).to_be_attached()
            visitor.let_fits_take_minutes()
            visitor.submit()
            expect(page.get_by_role("button", name="Cancel")).to_be_visible()
            page.get_by_role("button", name="Cancel").click()
            expect(page.get_by_role("heading", name="Canceled")).to_be_visible()


def test_problems_are_told_where_they_arise(visitor: Visitor):
    page = visitor.page
    visitor.open_sample()
    visitor.describe_person("18")
    expect(page.get_by_text("Between 120 and 230 cm")).to_be_visible()
    expect(page.get_by_role("button", name="Correct the height")).to_be_disabled()
    page.get_by_label("Height", exact=True).fill("180.4")
    page.get_by_label("Weight", exact=True).fill("400")
    visitor.click_points(LIMBS)
    expect(page.get_by_role("alert").first).to_contain_text("eight")
    page.goto(f"{visitor.origin}/#/fits/00000000-0000-0000-0000-000000000000")
    expect(page.get_by_role("heading", name="This result is gone")).to_be_visible()


def test_another_picture_without_a_lens_in_it_is_said_so(visitor: Visitor, tmp_path: Path):
    file = tmp_path / "plain.png"
    Image.new("RGB", (640, 480), (120, 90, 60)).save(file)
    page = visitor.page
    page.get_by_label("Choose a picture").set_input_files(file)
    visitor.correct()
    page.get_by_role("heading", name="Lens, shading and mask").click()
    expect(page.get_by_text("The picture names none: 50 mm are assumed.")).to_be_visible()
    page.get_by_label("Focal length, as on 35 mm film").fill("4.4")
    expect(page.get_by_text("Chosen by eye.")).to_be_visible()


def test_the_last_click_is_not_told_on_the_next_screen(visitor: Visitor, finished_fit: str):
    page = visitor.page
    visitor.open_sample()
    visitor.click_points(("left_shoulder",))
    region = page.locator("#page > p[role=status]")
    expect(region).to_contain_text("Left shoulder placed.")
    page.evaluate(f"location.hash = '#/fits/{finished_fit}'")
    visitor.wait_for_result()
    expect(region).to_be_empty()
    page.get_by_role("link", name="New").click()
    page.get_by_role("link", name="Continue with sample.jpg").click()
    visitor.wait_for_stage()
    expect(region).to_be_empty()


def test_escape_leaves_the_question_whether_to_delete(visitor: Visitor, finished_fit: str):
    page = visitor.page
    page.goto(f"{visitor.origin}/#/fits/{finished_fit}")
    visitor.wait_for_result()
    asker = page.get_by_role("button", name="Delete this result")
    asker.click()
    expect(page.get_by_role("button", name="Keep", exact=True)).to_be_focused()
    page.keyboard.press("Escape")
    expect(page.get_by_role("button", name="Delete", exact=True)).to_have_count(0)
    expect(asker).to_be_focused()
    # It asks again, and nothing was deleted.
    page.keyboard.press("Enter")
    expect(page.get_by_role("button", name="Keep", exact=True)).to_be_focused()
    page.keyboard.press("Enter")
    expect(asker).to_be_focused()
    page.reload()
    visitor.wait_for_result()


CLOSED = 2

GUIDE = f"""fit => new Promise((closed) => {{
  const told = [];
  const console = {{ log: ({{ state }}) => told.push(state) }};
  {block("events")}
  events.addEventListener("end", () => closed([told, events.readyState]));
}})"""


def test_who_follows_a_fit_as_the_guide_says_is_told_its_end(
    visitor: Visitor, service: httpx.Client, finished_fit: str
):
    fit = service.get(f"/v1/fits/{finished_fit}").json()
    told, ready_state = visitor.page.evaluate(GUIDE, fit)
    assert (told[0], told[-1]) == ("queued", "succeeded")
    assert ready_state == CLOSED


@pytest.mark.usefixtures("finished_fit")
def test_swagger_executes_every_post_at_once(visitor: Visitor):
    page = visitor.page
    page.goto(f"{visitor.origin}/docs")
    posts = page.locator(".opblock-post").filter(has=page.locator("[data-path^='/v1/']"))
    expect(posts).to_have_count(7)
    for post in posts.all():
        summary = post.locator(".opblock-summary-control")
        summary.click()
        post.get_by_role("button", name="Try it out").click()
        post.get_by_role("button", name="Execute").click()
        status = post.locator(".live-responses-table tbody .response-col_status")
        expect(status.first).to_contain_text("20")
        summary.click()


def test_good_and_bad_pictures_are_shown_on_demand(
    browser: Browser, service: httpx.Client, axe: str
):
    with Visitor.at(browser, str(service.base_url), PHONE | {"color_scheme": "dark"}) as visitor:
        page = visitor.page
        tiles = page.locator(".howto-tiles li")
        expect(tiles).to_have_count(0)
        with page.expect_response("**/page/measuring_tiles.jpg") as answered:
            page.get_by_text("For good measurements").click()
        assert answered.value.status == 200
        shown = {tile.get_attribute("data-code") for tile in tiles.all()}
        assert shown == {"good", *(code.value for code in set(Code) - WITHOUT_EXAMPLE)}
        expect(tiles.filter(has_text="Bad: arms on the body")).to_be_visible()
        assert serious_findings(page, axe) == []
        assert not page.evaluate("document.documentElement.scrollWidth > innerWidth")


NOTE_SIZES = """() => {
  window.sizes = [];
  new MutationObserver((mutations) => {
    for (const { target } of mutations)
      if (target.matches("canvas")) window.sizes.push([target.width, target.clientWidth]);
  }).observe(document, { subtree: true, attributeFilter: ["data-shows"] });
}"""


def test_a_canvas_says_what_it_shows_once_it_has_its_size(visitor: Visitor, finished_fit: str):
    page = visitor.page
    # The skin, which comes at any time, leaves the body less room.
    page.route("**/products", lambda route: route.abort())
    page.evaluate(NOTE_SIZES)
    page.goto(f"{visitor.origin}/#/fits/{finished_fit}")
    visitor.wait_until_drawn(placement="canonical")
    sizes = page.evaluate("window.sizes")
    assert sizes
    assert all(abs(drawn - seen) <= 1 for drawn, seen in sizes), sizes
