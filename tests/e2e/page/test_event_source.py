"""The browser's own EventSource, which reconnects by itself until it is told not to."""

import httpx
from playwright.sync_api import expect

from tests.e2e.page.visitor import Visitor

FOLLOW = """path => {
  const { dataset } = document.documentElement;
  const source = new EventSource(path);
  dataset.ends = "0";
  source.addEventListener("end", () => (dataset.ends = String(Number(dataset.ends) + 1)));
  source.addEventListener("error", () => (dataset.source = String(source.readyState)));
}"""
CLOSED = "2"


def test_an_event_source_hears_the_end_once_and_lets_go(
    visitor: Visitor, service: httpx.Client, finished_fit: str
):
    events = service.get(f"/v1/fits/{finished_fit}").json()["links"]["events"]
    visitor.page.evaluate(FOLLOW, events)
    root = visitor.page.locator("html")
    expect(root).to_have_attribute("data-source", CLOSED)
    expect(root).to_have_attribute("data-ends", "1")
    # One connection brought the events, the other was told that there are no more.
    assert sum(url.endswith(events) for url in visitor.requests) == 2
