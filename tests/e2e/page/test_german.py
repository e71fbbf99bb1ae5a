"""The page in German: no English from a sample to a result, and nothing that runs over."""

import re
from collections.abc import Iterable
from pathlib import Path

import httpx
import pytest
from playwright.sync_api import Browser, Page, expect

from tests.e2e.page.test_for_everyone import axe, serious_findings
from tests.e2e.page.visitor import DESK, PHONE, Visitor
from tests.e2e.service import REPOSITORY

__all__ = ["axe"]

DIST = REPOSITORY / "service" / "page" / "dist"

ENGLISH_LEFT = """async ([enPath, dePath]) => {
  const [{ en }, { de }] = await Promise.all([import(enPath), import(dePath)]);
  const sayings = (words) =>
    Object.values(words ?? {}).flatMap((word) =>
      typeof word === "string" ? [word.trim()] : typeof word === "object" ? sayings(word) : []);
  const german = new Set(sayings(de));
  const english = new Set(sayings(en).filter((word) => word && !german.has(word)));
  const foreign = /\\b(the|of|and|with|is|are|from|this|by|it|to|you)\\b/i;
  const seen = [];
  const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
  for (let node = walker.nextNode(); node; node = walker.nextNode())
    if (node.parentElement.checkVisibility() && !node.parentElement.closest("[lang=en], code"))
      seen.push(node.data);
  for (const element of document.querySelectorAll("body *:not([lang=en])"))
    for (const name of ["aria-label", "aria-valuetext", "title", "placeholder", "alt"])
      if (element.hasAttribute(name)) seen.push(element.getAttribute(name));
  const told = seen.map((text) => text.replace(/\\s+/g, " ").trim()).filter(Boolean);
  const left = told.filter((text) => english.has(text) || foreign.test(text));
  return { count: told.length, left };
}"""
"""Of all that is seen or read out, what the English catalogue says, or has an English particle."""

OVERFLOWING = """() => [...document.querySelectorAll(
    "button, .button, summary, th, td, label, legend, h1, h2, h3, .head-link, .choice-row span")]
  .filter((each) => each.checkVisibility() && !each.closest(".unseen") && !each.matches(".unseen"))
  .filter((each) => {
    const room = each.getBoundingClientRect();
    const page = document.documentElement.clientWidth;
    const isBlock = getComputedStyle(each).display !== "inline";
    const isCut = isBlock && each.scrollWidth > each.clientWidth + 1;
    return room.width > 0 && (isCut || room.right > page + 1);
  })
  .map((each) => `${each.tagName} ${each.className}: ${each.textContent}`)"""


def english_left(page: Page, *, of_at_least: int = 11) -> list[str]:
    catalogues = [f"/page/{only(DIST.glob(f'{language}.*.js')).name}" for language in ("en", "de")]
    found = page.evaluate(ENGLISH_LEFT, catalogues)
    assert found["count"] >= of_at_least
    return found["left"]


def only(paths: Iterable[Path]) -> Path:
    (path,) = paths
    return path


def open_folds(page: Page) -> None:
    page.evaluate("document.querySelectorAll('details').forEach((each) => (each.open = true))")


@pytest.mark.parametrize("device", [DESK, PHONE], ids=["desk", "phone"])
def test_from_a_sample_to_a_result_there_is_no_english(
    browser: Browser, service: httpx.Client, axe: str, device: dict
):
    german = {"locale": "de-DE"}
    with Visitor.at(browser, str(service.base_url), device, **german) as visitor:
        page = visitor.page

        def sound() -> None:
            assert english_left(page) == []
            assert page.evaluate(OVERFLOWING) == []
            assert not page.evaluate("document.documentElement.scrollWidth > innerWidth")

        expect(page.get_by_role("heading", name="Ein Körper in 3D")).to_be_visible()
        expect(page.locator("html")).to_have_attribute("lang", "de")
        sound()
        page.get_by_role("button", name="Entspannt").click()
        visitor.wait_for_stage()
        expect(page.get_by_label("Körperhöhe", exact=True)).to_have_value("180,4")
        expect(page.locator(".live-outline")).to_be_attached()
        open_folds(page)
        sound()
        assert serious_findings(page, axe) == []

        with visitor.without_news():
            page.get_by_role("button", name="Körper bestimmen").click()
            expect(page).to_have_url(re.compile(r"#/fits/[0-9a-f-]{36}$"))
            expect(page.get_by_role("progressbar")).to_be_visible()
            sound()
        visitor.wait_for_result()
        visitor.wait_until_drawn(placement="canonical")
        expect(page.get_by_role("row", name=re.compile("^Körperhöhe"))).to_contain_text("180,4")
        expect(page.get_by_role("row", name=re.compile("^Gewicht"))).to_contain_text(
            re.compile(r"\d,\d.*\d,\d – \d+,\d")
        )
        page.get_by_label(re.compile("^Mit der Auswertung nur nach dem Umriss")).check()
        open_folds(page)
        for kind in ("Abbildung", "Andere Haltung", "Animation", "Textur", "Karikatur"):
            visitor.choose(kind)
            sound()
        visitor.choose("Gemeinsamer Körper")
        expect(page.get_by_role("group", name="Andere Bilder")).to_have_attribute(
            "aria-busy", "false"
        )
        sound()
        assert serious_findings(page, axe) == []
        page.get_by_role("button", name="Verlauf").click()
        expect(page.get_by_role("dialog")).to_contain_text("Fertig")
        sound()
        assert serious_findings(page, axe) == []


def test_the_switch_changes_the_language_at_once_and_is_remembered(visitor: Visitor):
    page = visitor.page
    expect(page.locator("html")).to_have_attribute("lang", "en")
    visitor.open_sample(with_points=True)
    page.get_by_role("button", name="Deutsch").click()
    expect(page.locator("html")).to_have_attribute("lang", "de")
    # The draft stays as it is.
    expect(page.get_by_role("button", name="Körper bestimmen")).to_be_enabled()
    page.reload()
    expect(page.get_by_role("button", name="Körper bestimmen")).to_be_enabled()
    page.get_by_role("link", name="Maquette: Startseite").click()
    expect(page.get_by_role("heading", name="Ein Körper in 3D")).to_be_visible()
    page.get_by_role("button", name="English").click()
    expect(page.get_by_role("heading", name="A body in 3D")).to_be_visible()


def test_only_the_language_spoken_is_loaded(browser: Browser, service: httpx.Client):
    with Visitor.at(browser, str(service.base_url), locale="de-AT") as visitor:
        expect(visitor.page.locator("html")).to_have_attribute("lang", "de")
        asked = {url.rpartition("/")[2] for url in visitor.requests}
    names = {language: only(DIST.glob(f"{language}.*.js")).name for language in ("en", "de")}
    assert names["de"] in asked
    assert names["en"] not in asked


def test_what_is_wrong_is_said_in_german(browser: Browser, service: httpx.Client):
    with Visitor.at(browser, str(service.base_url), locale="de") as visitor:
        page = visitor.page
        page.goto(f"{visitor.origin}/#/fits/00000000-0000-0000-0000-000000000000")
        expect(page.get_by_role("heading", name="Diese Auswertung gibt es nicht")).to_be_visible()
        assert english_left(page) == []
        page.goto(f"{visitor.origin}/#/")
        page.get_by_role("button", name="Entspannt").click()
        visitor.wait_for_stage()
        page.get_by_label("Gewicht", exact=True).fill("400")
        expect(page.get_by_role("alert").first).to_contain_text("Gewicht: ")
        assert english_left(page) == []
