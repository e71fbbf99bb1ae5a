"""A scan's result is looked at as a fit's is: from its sides, with labels at its tapes."""

import re

from playwright.sync_api import Route, expect

from tests.e2e.page.test_for_everyone import axe, serious_findings
from tests.e2e.page.test_measure_result import open_scan, scan
from tests.e2e.page.visitor import Visitor

__all__ = ("axe", "scan")


def test_its_body_is_looked_at_from_its_sides_and_its_tapes_are_labelled(
    visitor: Visitor, scan: dict, axe: str
):
    open_scan(visitor, scan)
    page = visitor.page
    visitor.choose("Turn")
    seen = visitor.wait_until_drawn(placement="canonical")
    for side in ("side", "back", "front"):
        page.get_by_role("button", name=f"From the {side}", exact=True).click()
        seen = visitor.wait_for_change(visitor.body, seen, share=0.02)
    labels = page.get_by_role("group", name="Measurements on the body")
    hip = labels.get_by_role("button", name=re.compile(r"^Hip \d"))
    row = page.get_by_role("row", name=re.compile(r"^Hip \d"))
    expect(hip).to_contain_text(row.locator(".number").first.inner_text().split()[0])
    hip.click()
    expect(row).to_be_in_viewport()
    page.get_by_role("heading", name="The body", exact=True).hover()
    visitor.wait_until_drawn(placement="canonical", marked="hip_girth")
    expect(row).to_have_class("is-pointed")
    assert serious_findings(page, axe) == []
    page.get_by_role("heading", name="The body", exact=True).click()
    page.keyboard.press("Escape")
    visitor.wait_until_drawn(placement="canonical")
    expect(row).not_to_have_class("is-pointed")


def test_measurements_are_there_before_the_bodies(visitor: Visitor, scan: dict):
    page = visitor.page
    held: list[Route] = []
    bodies = re.compile(r"(\.glb|overlay_\d\.png)$")
    page.route(bodies, lambda route: held.append(route))
    page.goto(f"{visitor.origin}/#/scans/{scan['id']}")
    expect(page.get_by_role("row", name=re.compile("^Weight"))).to_be_visible()
    expect(page.get_by_text("The body is loading: 0%")).to_be_visible()
    expect(page.get_by_alt_text("The picture")).to_have_count(2)
    visitor.choose("Turn")
    expect(page.get_by_role("progressbar", name="The body is loading")).to_be_visible()
    # Before the rule goes: with it the browser lets go what is held.
    for route in held:
        route.continue_()
    page.unroute(bodies)
    visitor.wait_until_drawn(placement="canonical")
    expect(page.get_by_role("progressbar", name="The body is loading")).to_have_count(0)
