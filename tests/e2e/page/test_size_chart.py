"""The head of a size chart in German, whose names are long: all of them can be read."""

import httpx
import pytest
from playwright.sync_api import Browser, expect

from tests.e2e.page.visitor import DESK, PHONE, Visitor

NARROW_DESK = {"viewport": {"width": 1000, "height": 800}}
IS_CUT = """(name) =>
  name.scrollWidth > name.clientWidth || name.scrollHeight > name.clientHeight"""
LINES = """(name) => {
  const range = document.createRange();
  range.selectNodeContents(name);
  return new Set([...range.getClientRects()].map(({ bottom }) => Math.round(bottom))).size;
}"""


@pytest.mark.parametrize("device", [DESK, NARROW_DESK, PHONE], ids=["desk", "narrow desk", "phone"])
def test_names_of_columns_are_whole(
    browser: Browser, service: httpx.Client, finished_fit: str, device: dict
):
    with Visitor.at(browser, str(service.base_url), device, locale="de") as visitor:
        page = visitor.page
        page.goto(f"{visitor.origin}/#/fits/{finished_fit}")
        visitor.wait_for_result()
        visitor.choose("Konfektionsgröße")
        chosen = page.get_by_label("Spalte 1", exact=True)
        chosen.select_option(label="Oberschenkelumfang")
        names = page.locator(".size-chart thead span")
        expect(names.first).to_have_text("Ober\u00adschenkel\u00adumfang")
        for name in names.all():
            assert not name.evaluate(IS_CUT)
        # Broken where words end, not anywhere.
        assert names.first.evaluate(LINES) <= 3
        box, shown = chosen.bounding_box(), names.first.bounding_box()
        assert box == pytest.approx(shown, abs=1)
