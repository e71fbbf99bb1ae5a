"""A sandbox's page says that its results are canned; that of any other service does not.

That a sandbox answers that it is one, is tested where one runs (``test_sandbox``).
"""

import httpx
import pytest
from playwright.sync_api import Browser, Route, expect

from tests.e2e.page.visitor import Visitor

NOTES = {
    "en-GB": "the result is that of a sample",
    "de-DE": "Jedes Ergebnis ist das eines Beispiels",
}


def as_of_a_sandbox(route: Route) -> None:
    """Answer with the service's index, as a sandbox has it; with the page as it is."""
    if route.request.headers.get("accept") != "application/json":
        route.continue_()
        return
    answer = route.fetch()
    route.fulfill(response=answer, json=answer.json() | {"sandbox": True})


@pytest.mark.parametrize("language", NOTES)
def test_every_screen_says_so(browser: Browser, service: httpx.Client, language: str):
    with Visitor.at(browser, str(service.base_url), locale=language) as visitor:
        page = visitor.page
        page.route(lambda url: url == visitor.origin + "/", as_of_a_sandbox)
        page.reload()
        note = page.get_by_role("note").filter(has_text=NOTES[language])
        for address in ("#/", "#/prepare", "#/measure"):
            page.goto(f"{visitor.origin}/{address}")
            expect(note).to_be_visible()


def test_no_other_service_says_so(visitor: Visitor):
    page = visitor.page
    with page.expect_response(
        lambda answer: answer.request.headers.get("accept") == "application/json"
    ):
        page.reload()
    expect(page.get_by_role("heading", level=1)).to_be_visible()
    expect(page.locator(".sandbox-note")).to_have_count(0)
