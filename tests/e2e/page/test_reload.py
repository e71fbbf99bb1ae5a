"""A fit that is being prepared outlives a reload, in this browser alone, until it is sent."""

from collections.abc import Mapping
from typing import Any

from playwright.sync_api import Page, expect

from tests.e2e.page.test_drafts import WOMAN, is_blank, uploads
from tests.e2e.page.test_mask import CORNER, HEART, open_brushes, paint, wait_for_mask
from tests.e2e.page.visitor import Visitor

STORED = """async (key) => {
  const asked = indexedDB.open("maquette");
  await new Promise((done) => { asked.onsuccess = done; });
  const found = asked.result.transaction("draft").objectStore("draft").get(key);
  await new Promise((done) => { found.onsuccess = done; });
  asked.result.close();
  return JSON.parse(JSON.stringify(found.result ?? null));
}"""
LOOKS = 200


def stored(page: Page, key: str) -> Any:
    return page.evaluate(STORED, key)


def wait_for_stored(page: Page, said: Mapping[str, str]) -> None:
    """Wait until this is kept of the person."""
    for _ in range(LOOKS):
        rest = stored(page, "rest")
        if rest is not None and said.items() <= rest["person"].items():
            return
        page.wait_for_timeout(50)
    message = f"{said} is not kept: {stored(page, 'rest')}"
    raise AssertionError(message)


def test_the_same_screen_stands_there_after_a_reload(visitor: Visitor):
    page = visitor.page
    visitor.open_sample()
    visitor.describe_person("179.5")
    visitor.click_points(("left_shoulder", "right_shoulder", "left_elbow"))
    page.get_by_role("heading", name="Lens and light").click()
    page.get_by_label("Focal length, as on 35 mm film").fill("4.4")
    page.get_by_role("slider", name="Direction of the light").press("ArrowRight")
    page.get_by_role("heading", name="What the fit goes by").click()
    visitor.choose("Outline alone")
    visitor.choose("Loose")
    where = visitor.place_of("left_elbow")
    page.get_by_label("Weight", exact=True).fill("80")
    wait_for_stored(page, {"weight": "80"})
    before = uploads(visitor)
    page.reload()
    visitor.wait_for_stage()
    expect(visitor.points()).to_have_count(3)
    visitor.wait_for_place("left_elbow", where)
    expect(page.get_by_role("radio", name="Male", exact=True)).to_be_checked()
    expect(page.get_by_label("Height", exact=True)).to_have_value("179.5")
    expect(page.get_by_role("button", name="Undo")).to_be_disabled()
    page.get_by_role("heading", name="What the fit goes by").click()
    for said in ("Outline alone", "Loose"):
        expect(page.get_by_role("radio", name=said, exact=True)).to_be_checked()
    page.get_by_role("heading", name="Lens and light").click()
    expect(page.get_by_text("Chosen by eye.")).to_be_visible()
    expect(page.get_by_text("5° from the right")).to_be_visible()
    # The fourth is asked for next. The picture was sent once more, and once only.
    expect(page.locator(".next-name")).to_have_text("Right elbow")
    assert uploads(visitor) == before + 1


def test_what_brushes_did_to_the_mask_is_there_after_a_reload(visitor: Visitor):
    page = visitor.page
    open_brushes(visitor)
    paint(visitor, CORNER)
    wait_for_mask(visitor, CORNER, is_person=True)
    page.get_by_role("radio", name="Female", exact=True).check()
    page.get_by_label("Weight", exact=True).fill("61")
    wait_for_stored(page, {"weight": "61"})
    page.reload()
    visitor.wait_for_stage()
    visitor.correct()
    expect(page.get_by_role("button", name="Discard the edits")).to_be_visible()
    page.get_by_role("button", name="Look and correct").click()
    expect(page.locator(".mask-stage")).to_have_attribute("aria-busy", "false")
    for spot in (HEART, CORNER):
        wait_for_mask(visitor, spot, is_person=True)


def test_it_waits_on_the_first_screen_and_nothing_of_it_is_sent(visitor: Visitor):
    page = visitor.page
    visitor.open_sample(with_points=True)
    wait_for_stored(page, {"height": "180.4"})
    page.get_by_role("link", name="Maquette: start").click()
    before = uploads(visitor)
    page.reload()
    expect(page.get_by_role("link", name="Go on with sample.jpg")).to_be_visible()
    assert uploads(visitor) == before
    page.get_by_role("link", name="Go on with sample.jpg").click()
    expect(page.locator(".live-outline")).to_be_attached()
    assert uploads(visitor) == before + 1
    page.get_by_role("link", name="Maquette: start").click()
    page.get_by_role("button", name="Discard it").click()
    page.wait_for_function(f"async () => (await ({STORED})('id')) === null")
    page.reload()
    expect(page.get_by_role("button", name="At ease")).to_be_visible()
    expect(page.get_by_role("link", name="Go on with")).to_have_count(0)


def test_another_picture_takes_its_place_and_a_fit_that_is_accepted_erases_it(visitor: Visitor):
    page = visitor.page
    visitor.open_sample(with_points=True)
    wait_for_stored(page, {"height": "180.4"})
    visitor.correct()
    page.get_by_label("Choose another picture").set_input_files(WOMAN)
    wait_for_stored(page, {"height": ""})
    page.reload()
    visitor.wait_for_stage()
    visitor.correct()
    expect(page.get_by_text("woman.jpg")).to_be_visible()
    is_blank(page)
    visitor.let_fits_take_minutes()
    page.goto(f"{visitor.origin}/#/")
    visitor.open_sample(with_points=True)
    wait_for_stored(page, {"height": "180.4"})
    visitor.submit()
    page.get_by_role("button", name="Cancel").click()
    expect(page.get_by_role("heading", name="The fit was canceled")).to_be_visible()
    assert stored(page, "id") is None
    assert stored(page, "picture") is None


def test_without_a_database_the_page_works_all_the_same(visitor: Visitor):
    page = visitor.page
    page.add_init_script("Object.defineProperty(window, 'indexedDB', { value: undefined });")
    page.reload()
    visitor.open_sample(with_points=True)
    expect(page.locator(".live-outline")).to_be_attached()
    page.reload()
    expect(page.get_by_role("button", name="At ease")).to_be_visible()
