"""The page in a frame of another site: the documented example, from pictures to measurements."""

import os
import re
import shutil
import subprocess

import pytest
from playwright.sync_api import Browser, Playwright, Route, expect

from tests.e2e.page.browser import chromium
from tests.e2e.page.embedded import (
    Embedding,
    at,
    begin,
    embedding,
    fits_into_its_frame,
    own_frame,
    wait_for_checks,
)
from tests.e2e.page.embedding import DOCUMENT
from tests.e2e.page.test_for_everyone import axe, serious_findings
from tests.e2e.page.visitor import FIT_WITHIN_MS, LABELS_ARE_SEEN, PHONE
from tests.readme import block

__all__ = ("axe", "embedding")

WIDE = {"viewport": {"width": 1440, "height": 900}}
NO_STORAGE = """for (const name of ["localStorage", "sessionStorage"])
  Object.defineProperty(window, name, { get() { throw new DOMException("", "SecurityError"); } });
"""
COVERS = """(covers) => {
  const { top, height } = document.querySelector("iframe").getBoundingClientRect();
  return covers === (top === 0 && height === innerHeight);
}"""
LISTENS = """() => addEventListener("message", ({ data }) => {
  if (data.height === 50) window.toldTooShort = true;
})"""
TOO_SHORT = """() => {
  const message = { type: "maquette:resize", height: 50 };
  parent.postMessage(message, "*");
}"""
ALLOW_ALL = """() => document.querySelector("iframe").contentWindow.postMessage(
  { type: "maquette:start", allow: ["save", "delete"] }, "*")"""
MOST_STAGE_PX = 680
WAIST = re.compile(r"^Waist: \d+\.\d cm$")


@pytest.mark.parametrize(
    ("of", "device", "scheme"),
    [("site", PHONE, "dark"), ("neighbour", WIDE, "light")],
    ids=["another site, phone", "another origin of the site, desk"],
)
def test_measurements_of_pictures_that_the_site_gave_arrive_there(
    browser: Browser, embedding: Embedding, axe: str, of: str, device: dict, scheme: str
):
    settled = {"color_scheme": scheme}
    address = getattr(embedding, of).origin + "/"
    with at(browser, address, device, **settled) as page:
        frame = begin(page)
        wait_for_checks(frame)
        expect(frame.get_by_label("Height", exact=True)).to_have_value("155.5")
        expect(frame.get_by_label("Weight", exact=True)).to_have_value("52")
        expect(frame.get_by_role("banner")).to_have_count(0)
        expect(page.get_by_title("Measure a body")).to_be_visible()
        assert serious_findings(own_frame(page), axe) == []
        fits_into_its_frame(page)
        frame.get_by_role("button", name="Measure", exact=True).click()
        expect(page.locator("#told")).to_have_text(WAIST, timeout=FIT_WITHIN_MS)
        expect(frame.locator('[data-fit][aria-busy="false"]')).to_be_attached()
        expect(frame.locator('.body-canvas[data-shows^="canonical clay"]')).to_be_visible()
        own_frame(page).wait_for_function(LABELS_ARE_SEEN)
        stage = frame.locator(".bench-stage").bounding_box()
        assert stage is not None
        assert stage["height"] <= MOST_STAGE_PX
        # A visitor reads; files and Delete are the site's to offer.
        files = frame.get_by_role("heading", name="Files", exact=True)
        delete = frame.get_by_role("button", name="Delete this scan")
        for offered in (files, delete, frame.get_by_text("Save", exact=True)):
            expect(offered).to_have_count(0)
        page.evaluate(ALLOW_ALL)
        for offered in (files, delete, frame.get_by_text("Save", exact=True)):
            expect(offered).to_be_visible()
        assert serious_findings(own_frame(page), axe) == []
        fits_into_its_frame(page)
        scan = embedding.service.get("/v1/scans").raise_for_status().json()["scans"][0]
        assert scan["label"] == "customer-4711"
        # The browser keeps nothing of it, where it would, and its way back is the site's own.
        if of == "neighbour":
            stored = "localStorage.length + sessionStorage.length"
            assert own_frame(page).evaluate(stored) == 0
        assert page.evaluate("history.length") <= 2


def test_a_site_that_is_not_named_is_told_that_it_may_not_show_the_page(
    browser: Browser, embedding: Embedding
):
    with at(browser, embedding.stranger.origin + "/") as page:
        begin(page)
        expect(page.locator("#told")).to_contain_text("MAQUETTE_EMBED_ORIGINS")
        assert [each.url for each in page.frames if each.url.startswith("http")] == [
            f"{embedding.stranger.origin}/"
        ]
        assert embedding.stranger.handed_out == []


def test_messages_of_other_windows_are_ignored(browser: Browser, embedding: Embedding):
    with at(browser, embedding.site.origin + "/") as page:
        frame = begin(page)
        wait_for_checks(frame)
        page.evaluate("""() => {
          window.heard = [];
          addEventListener("message", ({ data }) => heard.push(data.field ?? data.type));
          const other = document.createElement("iframe");
          document.body.append(other);
          other.contentWindow.eval(`
            const forged = { type: "maquette:result", measurements: [], verdict: "forged" };
            parent.postMessage(forged, "*");
            parent.frames[0].postMessage({ type: "maquette:start", subject: { gender: "x" } }, "*");
          `);
          const own = document.querySelector("iframe").contentWindow;
          own.postMessage({ type: "maquette:start", subject: { height_m: 9 } }, "*");
        }""")
        page.wait_for_function("heard.some((each) => each.startsWith('subject.'))")
        told = page.evaluate("heard")
        assert "subject.height_m" in told
        assert "subject.gender" not in told
        expect(page.locator("#told")).not_to_contain_text("forged")


def test_an_expired_token_is_asked_for_anew_and_work_goes_on(
    browser: Browser, embedding: Embedding
):
    site = embedding.site
    assert site.make_token is not None
    site.first_tokens = [site.make_token("customer-4711")]
    embedding.expire(site.first_tokens[0])
    site.handed_out.clear()
    with at(browser, site.origin + "/") as page:
        frame = begin(page)
        wait_for_checks(frame)
        assert len(site.handed_out) == 2
        # What was uploaded with that one is not there for the next.
        embedding.expire(site.handed_out[1])
        renewed: list[str] = []

        def expire_at_work(route: Route) -> None:
            if not renewed:
                renewed.append(site.handed_out[-1])
                embedding.expire(renewed[0])
            route.continue_()

        page.route("**/v1/scans/*/events", expire_at_work)
        frame.get_by_role("button", name="Measure", exact=True).click()
        expect(page.locator("#told")).to_have_text(WAIST, timeout=FIT_WITHIN_MS)
        assert renewed == [site.handed_out[2]]
        assert len(site.handed_out) == 4
        expect(frame.locator('[data-fit][aria-busy="false"]')).to_be_attached()


def test_a_site_whose_tokens_are_never_accepted_is_told_so(browser: Browser, embedding: Embedding):
    embedding.site.first_tokens = ["mqt_wrong", "mqt_wronger"]
    with at(browser, embedding.site.origin + "/") as page:
        begin(page)
        expect(page.locator("#told")).to_contain_text("refused this token as well")
        assert embedding.site.first_tokens == []


def test_an_option_that_cannot_be_meant_is_named(browser: Browser, embedding: Embedding):
    with at(browser, embedding.site.origin + "/") as page:
        refused = page.evaluate("""async () => {
          const text = new Blob(["no picture"], { type: "image/jpeg" });
          const refused = (options) =>
            Maquette.measure(frame, options).catch(({ field, message }) => [field, message]);
          return [
            await refused({ subject: { height_cm: 155 } }),
            await refused({ lang: "xx" }),
            await refused({ pictures: { side: text } }),
          ];
        }""")
        assert [field for field, _ in refused] == ["subject.height_cm", "lang", "pictures.side"]
        assert "height_m" in refused[0][1]


def test_the_page_speaks_german_where_the_site_says_so_and_works_without_storage(
    browser: Browser, embedding: Embedding
):
    with at(browser, "about:blank") as page:
        page.context.add_init_script(NO_STORAGE)
        page.goto(embedding.site.origin + "/de")
        frame = begin(page)
        expect(frame.get_by_label("Körperhöhe", exact=True)).to_have_value("155,5")
        expect(page.get_by_title("Körper vermessen")).to_be_visible()
        expect(frame.locator("html")).to_have_attribute("lang", "de")
        wait_for_checks(frame)
        page.wait_for_function("document.querySelector('iframe').offsetHeight > 600")


def test_a_visitor_cancels(browser: Browser, embedding: Embedding):
    with at(browser, embedding.site.origin + "/") as page:
        frame = begin(page)
        wait_for_checks(frame)
        frame.get_by_role("button", name="Measure", exact=True).click()
        frame.get_by_role("button", name="Cancel").click()
        expect(page.locator("#told")).to_have_text("The visitor cancelled.")
        page.evaluate("frame.replaceChildren()")
        aborted = page.evaluate("""async () => {
          const leaving = new AbortController();
          setTimeout(() => leaving.abort());
          const { signal } = leaving;
          const error = await Maquette.measure(frame, { signal }).catch((error) => error);
          return [error.name, frame.childElementCount];
        }""")
        assert aborted == ["AbortError", 0]


def test_the_camera_takes_the_window_and_gives_it_back(
    playwright: Playwright, embedding: Embedding
):
    flags = ("--use-fake-device-for-media-stream", "--use-fake-ui-for-media-stream")
    with (
        chromium(playwright, *flags) as browser,
        at(browser, embedding.site.origin + "/", {"viewport": PHONE["viewport"]}) as page,
    ):
        page.get_by_role("button", name="Measure me").click()
        frame = page.frame_locator("iframe")
        take = frame.locator('[data-place="front"]').get_by_role("button", name="Take a picture")
        expect(take).to_be_visible()
        # Before the frame is as tall as what it shows, a click would scroll within it.
        fits_into_its_frame(page)
        page.evaluate("scrollTo(0, 60)")
        take.click()
        expect(frame.get_by_role("button", name="Take it in 5 s")).to_be_enabled()
        page.wait_for_function(COVERS, arg=True)
        scrolled = page.evaluate("scrollY")
        page.evaluate(LISTENS)
        own_frame(page).evaluate(TOO_SHORT)
        page.wait_for_function("window.toldTooShort === true")
        assert page.evaluate(COVERS, True)
        frame.get_by_role("dialog").get_by_role("button", name="Close").click()
        page.wait_for_function(COVERS, arg=False)
        # The site is where it was, not at its top.
        assert page.evaluate("scrollY") == scrolled > 0
        fits_into_its_frame(page)


def test_the_frame_is_light_or_dark_as_the_site_says_and_follows_it(
    browser: Browser, embedding: Embedding
):
    with at(browser, embedding.site.origin + "/", color_scheme="light") as page:
        page.evaluate("frame.dataset.theme = 'dark'")
        shown = begin(page).locator("html")
        expect(shown).to_have_attribute("data-theme", "dark")
        page.evaluate("frame.dataset.theme = 'light'")
        expect(shown).to_have_attribute("data-theme", "light")
        page.emulate_media(color_scheme="dark")
        page.evaluate("frame.dataset.theme = 'system'")
        expect(shown).to_have_attribute("data-theme", "dark")
        page.emulate_media(color_scheme="light")
        expect(shown).to_have_attribute("data-theme", "light")
        page.evaluate("""() => {
          frame.replaceChildren();
          Maquette.measure(frame, { theme: "dark" }).catch(() => null);
        }""")
        expect(shown).to_have_attribute("data-theme", "dark")
        refused = page.evaluate("""() => {
          frame.removeAttribute("data-theme");
          return Maquette.measure(frame, { theme: "black" }).catch(({ field }) => field);
        }""")
        assert refused == "theme"


def test_the_messages_do_without_the_script(browser: Browser, embedding: Embedding):
    with at(browser, embedding.site.origin + "/messages") as page:
        frame = page.frame_locator("iframe")
        expect(frame.get_by_label("Height", exact=True)).to_have_value("180")
        fits_into_its_frame(page)


@pytest.mark.skipif(shutil.which("node") is None, reason="no Node.js to run the example")
def test_the_token_that_the_node_example_makes_is_good(embedding: Embedding):
    code = block("node", DOCUMENT) + 'console.log(await newToken("customer-4711"));'
    command = ["node", "--input-type=module", "-e", code]
    done = subprocess.run(command, capture_output=True, text=True, env=os.environ, check=True)
    headers = {"Authorization": f"Bearer {done.stdout.strip()}"}
    assert embedding.service.get("/v1/scans", headers=headers).json()["scans"] == []
