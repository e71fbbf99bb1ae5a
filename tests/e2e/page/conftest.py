from collections.abc import Iterator

import httpx
import pytest
from playwright.sync_api import Browser, Playwright, expect, sync_playwright

from tests.e2e.page.visitor import GIVEN_UP_AFTER_MS, Visitor, chromium
from tests.e2e.service import REPOSITORY
from tests.external_tools import installed

expect.set_options(timeout=GIVEN_UP_AFTER_MS)


@pytest.fixture(scope="package")
def playwright() -> Iterator[Playwright]:
    with sync_playwright() as started:
        yield started


@pytest.fixture(scope="package")
def browser(playwright: Playwright) -> Iterator[Browser]:
    with chromium(playwright) as running:
        yield running


@pytest.fixture
def visitor(browser: Browser, service: httpx.Client) -> Iterator[Visitor]:
    """Someone at a desk, with the page before them; nothing may have gone wrong at the end."""
    with Visitor.at(browser, str(service.base_url)) as someone:
        yield someone


@pytest.fixture(scope="package")
def axe() -> str:
    """The script that finds what is not accessible; see ``serious_findings``."""
    page = REPOSITORY / "service" / "page"
    installed(page)
    return (page / "node_modules" / "axe-core" / "axe.min.js").read_text()
