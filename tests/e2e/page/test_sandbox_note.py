"""A sandbox's page says that its results are canned; that of any other service does not."""

from collections.abc import Iterator

import httpx
import pytest
from playwright.sync_api import Browser, expect

from tests.e2e.page.visitor import DESK, Visitor
from tests.e2e.sandbox import running_sandbox

NOTES = {
    "en-GB": "every result is that of a sample",
    "de-DE": "Jedes Ergebnis ist das eines Beispiels",
}


@pytest.fixture(scope="module")
def sandbox(tmp_path_factory: pytest.TempPathFactory) -> Iterator[httpx.Client]:
    with running_sandbox(tmp_path_factory.mktemp("sandbox")) as client:
        yield client


@pytest.mark.parametrize("language", NOTES)
def test_every_screen_says_so(browser: Browser, sandbox: httpx.Client, language: str):
    with Visitor.at(browser, str(sandbox.base_url), DESK | {"locale": language}) as visitor:
        note = visitor.page.get_by_role("note").filter(has_text=NOTES[language])
        for address in ("#/", "#/prepare", "#/measure"):
            visitor.page.goto(f"{sandbox.base_url}/{address}")
            expect(note).to_be_visible()


def test_no_other_service_says_so(visitor: Visitor):
    page = visitor.page
    with page.expect_response(
        lambda answer: answer.request.headers.get("accept") == "application/json"
    ):
        page.reload()
    expect(page.get_by_role("heading", level=1)).to_be_visible()
    expect(page.locator(".sandbox-note")).to_have_count(0)
