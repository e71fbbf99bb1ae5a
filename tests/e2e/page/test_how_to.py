"""Good and bad pictures are shown where pictures are taken, from the service's own files."""

import httpx
import pytest
from playwright.sync_api import Browser, expect

from fitter.vocabulary.remarks import Code
from tests.e2e.page.test_for_everyone import axe, serious_findings
from tests.e2e.page.visitor import DESK, PHONE, Visitor
from tests.illustrations.measuring_sheet import WITHOUT_EXAMPLE

__all__ = ("axe",)


@pytest.mark.parametrize(
    ("device", "scheme"), [(PHONE, "dark"), (DESK, "light")], ids=["phone, dark", "desk, light"]
)
def test_good_and_bad_pictures_are_shown_on_demand(
    browser: Browser, service: httpx.Client, axe: str, device: dict, scheme: str
):
    settled = device | {"color_scheme": scheme}
    with Visitor.at(browser, str(service.base_url), settled) as visitor:
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
