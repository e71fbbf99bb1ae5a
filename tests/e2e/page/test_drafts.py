"""A fit that is being prepared: begun anew, left, gone on with, and of one person alone."""

import json
from pathlib import Path

from playwright.sync_api import Page, Route, expect

from service.demo_data import sample
from tests.e2e.page.visitor import Visitor

DATA = Path(sample.__file__).parent
WOMAN = DATA / "woman.jpg"
UPLOADS = "**/v1/images"


def fill_in(visitor: Visitor) -> None:
    page = visitor.page
    visitor.describe_person()
    page.get_by_label("Weight", exact=True).fill("81")
    page.get_by_text("Known measurements").click()
    page.get_by_label("Waist, at the navel", exact=True).fill("90")


def is_blank(page: Page) -> None:
    for gender in ("Female", "Male"):
        expect(page.get_by_role("radio", name=gender, exact=True)).not_to_be_checked()
    for told in ("Height", "Weight"):
        expect(page.get_by_label(told, exact=True)).to_have_value("")
    expect(page.locator("#tape-waist_girth_navel")).to_have_value("")


def uploads(visitor: Visitor) -> int:
    return sum(url.endswith("/v1/images") for url in visitor.requests)


def test_new_begins_with_samples_and_nobody(visitor: Visitor):
    page = visitor.page
    visitor.let_fits_take_minutes()
    visitor.open_sample(with_points=True)
    fill_in(visitor)
    visitor.submit()
    expect(page.get_by_role("progressbar", name="Progress of the fit")).to_be_visible()
    page.get_by_role("link", name="New").click()
    expect(page.get_by_role("button", name="At ease")).to_be_visible()
    expect(page.get_by_role("link", name="Go on with")).to_have_count(0)
    visitor.open_sample(name="Upright")
    is_blank(page)
    expect(visitor.points()).to_have_count(0)
    page.go_back()
    page.go_back()
    page.get_by_role("button", name="Cancel").click()
    expect(page.get_by_role("heading", name="The fit was canceled")).to_be_visible()


def test_the_logo_leaves_a_draft_that_can_be_gone_on_with_or_discarded(visitor: Visitor):
    page = visitor.page
    visitor.open_sample(with_points=True)
    fill_in(visitor)
    page.get_by_role("link", name="Maquette: start").click()
    expect(page.get_by_role("button", name="At ease")).to_be_visible()
    page.go_back()
    visitor.wait_for_stage()
    page.go_forward()
    page.get_by_role("link", name="Go on with sample.jpg").click()
    visitor.wait_for_stage()
    expect(page.get_by_label("Weight", exact=True)).to_have_value("81")
    expect(visitor.points()).not_to_have_count(0)
    page.go_back()
    page.get_by_role("button", name="Discard it").click()
    expect(page.get_by_role("link", name="Go on with")).to_have_count(0)
    page.goto(f"{visitor.origin}/#/prepare")
    expect(page.get_by_role("button", name="At ease")).to_be_visible()


def test_another_picture_is_another_person(visitor: Visitor):
    page = visitor.page
    visitor.open_sample(with_points=True)
    fill_in(visitor)
    before = uploads(visitor)
    visitor.correct()
    with page.expect_response(UPLOADS):
        page.get_by_label("Choose another picture").set_input_files(WOMAN)
    is_blank(page)
    assert uploads(visitor) == before + 1


def test_a_fit_that_is_changed_brings_its_own_person(visitor: Visitor, finished_fit: str):
    page = visitor.page
    visitor.open_sample(name="Upright")
    page.get_by_role("radio", name="Female", exact=True).check()
    page.get_by_label("Height", exact=True).fill("150")
    page.get_by_label("Weight", exact=True).fill("50")
    page.goto(f"{visitor.origin}/#/fits/{finished_fit}")
    visitor.wait_for_result()
    page.get_by_role("button", name="Correct something").click()
    visitor.wait_for_stage()
    expect(page.get_by_role("radio", name="Male", exact=True)).to_be_checked()
    expect(page.get_by_label("Height", exact=True)).to_have_value("180.4")
    expect(page.get_by_label("Weight", exact=True)).to_have_value("")


def test_a_sample_comes_as_one_and_overwrites_nothing(visitor: Visitor):
    page = visitor.page
    held: list[Route] = []
    page.route("**/page/sample.json", lambda route: held.append(route))
    page.get_by_role("button", name="At ease").click()
    page.wait_for_function(
        "() => performance.getEntriesByName(`${location.origin}/page/sample.jpg`).length > 0"
    )
    # Without its person it is not shown.
    expect(visitor.stage).to_have_count(0)
    held[0].continue_()
    visitor.wait_for_stage()
    known = json.loads((DATA / "request.json").read_text())
    expect(visitor.points()).to_have_count(len(known["points"]))
    expect(page.get_by_label("Height", exact=True)).to_have_value("180.4")
    page.get_by_label("Height", exact=True).fill("179")
    expect(page.locator(".live-outline")).to_be_attached()
    expect(page.get_by_label("Height", exact=True)).to_have_value("179")
    assert uploads(visitor) == 1
