"""From a picture to a body and its measurements by real clicks, in a real browser."""

import re

from playwright.sync_api import Browser, expect

from tests.e2e.page.visitor import LIMBS, Visitor
from tests.unit.export.glb_reader import read_glb


def test_the_sample_becomes_a_body_with_measurements_to_be_kept_and_erased(
    visitor: Visitor, browser: Browser, tmp_path
):
    page = visitor.page
    visitor.open_sample()
    visitor.describe_person()
    visitor.click_points(LIMBS)
    expect(page.locator(".live-outline")).to_be_attached()
    with visitor.without_news():
        visitor.submit()
        expect(page).to_have_url(re.compile(r"#/fits/[0-9a-f-]{36}$"))
        expect(page.get_by_role("progressbar", name="Progress")).to_be_visible()
    visitor.wait_for_result()
    visitor.wait_until_drawn(placement="canonical")

    # The body is drawn over its picture, lit as the fit found it, and can be turned.
    visitor.choose("Photo")
    visitor.wait_until_drawn(placement="picture")
    visitor.unfold_for_experts()
    look = page.locator(".look-picture")
    opacity = page.get_by_label("Opacity of the body")
    opacity.fill("0")
    bare = visitor.pixels(look)
    opacity.fill("1")
    covered = visitor.wait_for_change(look, bare, share=0.08)
    visitor.choose("Albedo")
    visitor.wait_for_change(look, covered, share=0.08)
    visitor.choose("Clay")
    visitor.choose("Body")
    expect(page.locator(".look-free")).to_be_visible()
    upright = visitor.wait_until_drawn(placement="canonical")
    visitor.body.focus()
    for _ in range(5):
        page.keyboard.press("ArrowRight")
    visitor.wait_for_change(visitor.body, upright, share=0.02)

    # Measurements near those of the man the sample was rendered from.
    row = page.get_by_role("row", name=re.compile("^Weight"))
    weight = float(re.search(r"Weight\s+([\d.]+)", row.inner_text())[1])
    assert 60.0 < weight < 95.0
    expect(page.get_by_role("row", name=re.compile("^Height"))).to_contain_text("given")

    # Where a measurement is taken is drawn on the upright body.
    visitor.choose("Photo")
    page.get_by_role("button", name="Waist, at the navel", exact=True).click()
    expect(page.get_by_role("radio", name="Body", exact=True)).to_be_checked()
    marked = visitor.wait_until_drawn(placement="canonical", marked="waist_girth_navel")
    page.get_by_role("button", name="Waist, at the navel", exact=True).click()
    page.get_by_role("heading", name="All measurements").hover()
    visitor.wait_for_change(visitor.body, marked, share=0.0005)

    page.get_by_text("Files", exact=True).click()
    with page.expect_download() as download:
        page.get_by_role("button", name=re.compile(r"body_posed\.glb")).click()
    kept = tmp_path / "body.glb"
    download.value.save_as(kept)
    document = read_glb(kept.read_bytes()).document
    assert document["scenes"][0]["name"] == "body_posed"
    for name, begins in (
        ("body_canonical.obj", b"# Maquette"),
        ("measurements.csv", b"name,value"),
    ):
        with page.expect_download() as download:
            page.get_by_role("button", name=re.compile(f"^{re.escape(name)}")).click()
        assert download.value.path().read_bytes().startswith(begins)
        assert download.value.suggested_filename == name

    # Its link opens it in another browser, which can change it; erasing it is for all.
    link = page.url
    with Visitor.at(browser, visitor.origin) as other:
        other.page.goto(link)
        other.wait_for_result()
        other.page.get_by_role("button", name="Adjust", exact=True).click()
        expect(other.points()).to_have_count(len(LIMBS))
        expect(other.page.get_by_label("Height", exact=True)).to_have_value("180.4")
    page.get_by_role("button", name="Delete this result").click()
    page.get_by_role("button", name="Delete", exact=True).click()
    expect(page.get_by_role("heading", name="Your measurements and your body")).to_be_visible()
    page.goto(link)
    expect(page.get_by_role("heading", name="This result is gone")).to_be_visible()


def test_a_fit_can_be_canceled_and_another_begun_meanwhile(visitor: Visitor):
    page = visitor.page
    visitor.let_fits_take_minutes()
    visitor.open_sample(with_points=True)
    visitor.submit()
    expect(page.get_by_role("progressbar", name="Progress")).to_be_visible()
    page.get_by_role("link", name="New").click()
    visitor.open_sample(with_points=True)
    visitor.submit()
    page.get_by_role("button", name="Cancel").click()
    expect(page.get_by_role("heading", name="Canceled")).to_be_visible()
    page.get_by_role("button", name=re.compile("^History")).click()
    expect(page.locator(".history li")).to_have_count(2)
    expect(page.locator(".history")).to_contain_text("Canceled")
    page.locator(".history a").last.click()
    page.get_by_role("button", name="Cancel").click()
    expect(page.get_by_role("heading", name="Canceled")).to_be_visible()
