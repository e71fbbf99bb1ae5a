"""A person measured from the front and from the side, on a phone."""

import re
from pathlib import Path

import httpx
import pytest
from playwright.sync_api import Browser, Page, expect

from service.demo_data import sample
from tests.e2e.page.test_for_everyone import axe, serious_findings
from tests.e2e.page.visitor import FIT_WITHIN_MS, PHONE, Visitor

__all__ = ("axe",)

DATA = Path(sample.__file__).parent


def place(page: Page, name: str):
    return page.locator(f'[data-place="{name}"]')


def no_wider_than_the_phone(page: Page) -> bool:
    return page.evaluate("document.documentElement.scrollWidth <= window.innerWidth")


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_the_sample_pair_is_measured_in_three_taps(
    browser: Browser, service: httpx.Client, axe: str, scheme: str
):
    settled = PHONE | {"color_scheme": scheme}
    with Visitor.at(browser, str(service.base_url), settled) as visitor:
        page = visitor.page
        page.get_by_role("link", name="Measure", exact=True).tap()
        expect(page.get_by_role("heading", name="Measure a person")).to_be_visible()
        assert serious_findings(page, axe) == []
        page.get_by_role("button", name="Try the sample pair").tap()
        for name in ("front", "side"):
            expect(place(page, name)).to_contain_text("Good to measure")
        assert serious_findings(page, axe) == []
        assert no_wider_than_the_phone(page)
        page.get_by_role("button", name="Measure", exact=True).tap()
        expect(page.locator('[data-fit][aria-busy="false"]')).to_be_attached(timeout=FIT_WITHIN_MS)
        expect(page).to_have_url(re.compile(r"#/scans/[0-9a-f-]{36}$"))
        visitor.wait_until_drawn(placement="canonical")
        row = page.get_by_role("row", name=re.compile("^Weight"))
        weight = float(re.search(r"Weight\s+([\d.]+)", row.inner_text())[1])
        assert 45.0 < weight < 65.0
        assert serious_findings(page, axe) == []
        assert no_wider_than_the_phone(page)


def test_a_picture_from_another_side_is_told_where_it_lies(browser: Browser, service: httpx.Client):
    with Visitor.at(browser, str(service.base_url), PHONE) as visitor:
        page = visitor.page
        page.get_by_role("link", name="Measure", exact=True).tap()
        chosen = place(page, "side").locator("input[type=file]")
        chosen.set_input_files(DATA / "front.jpg")
        expect(place(page, "side").locator('[data-code="other-view"]')).to_be_visible()
        chosen.set_input_files(DATA / "side.jpg")
        expect(place(page, "side")).to_contain_text("Good to measure")
