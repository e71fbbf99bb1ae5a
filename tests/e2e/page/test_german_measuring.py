"""The screen Measure in German: from the sample pair to a size there is no English."""

import re
from pathlib import Path

import httpx
import pytest
from playwright.sync_api import Browser, Page, expect

from service.demo_data import sample
from tests.e2e.page.test_for_everyone import axe, serious_findings
from tests.e2e.page.test_german import OVERFLOWING, english_left, open_folds
from tests.e2e.page.visitor import DESK, FIT_WITHIN_MS, PHONE, Visitor

__all__ = ["axe"]

DATA = Path(sample.__file__).parent
WIDE = DESK | {"viewport": {"width": 1440, "height": 900}}
GERMAN = {"locale": "de-DE"}


def sound(page: Page) -> None:
    assert english_left(page) == []
    assert page.evaluate(OVERFLOWING) == []
    assert not page.evaluate("document.documentElement.scrollWidth > innerWidth")


@pytest.mark.parametrize(
    ("device", "scheme"), [(PHONE, "dark"), (WIDE, "light")], ids=["phone, dark", "desk, light"]
)
def test_from_the_sample_pair_to_a_size_there_is_no_english(
    browser: Browser, service: httpx.Client, axe: str, device: dict, scheme: str
):
    settled = device | GERMAN | {"color_scheme": scheme}
    with Visitor.at(browser, str(service.base_url), settled) as visitor:
        page = visitor.page
        page.get_by_role("link", name="Messen", exact=True).click()
        expect(page.get_by_role("heading", name="Eine Person messen")).to_be_visible()
        open_folds(page)
        expect(page.get_by_text("Schlecht: Arme am Körper")).to_be_visible()
        sound(page)
        assert serious_findings(page, axe) == []
        page.get_by_role("button", name="Beispielbilder nehmen").click()
        for name in ("front", "side"):
            place = page.locator(f'[data-place="{name}"]')
            expect(place).to_contain_text("Gut zum Messen")
        expect(page.get_by_label("Körperhöhe", exact=True)).to_have_value("155,5")
        sound(page)
        assert serious_findings(page, axe) == []

        with visitor.without_news():
            page.get_by_role("button", name="Messen", exact=True).click()
            expect(page).to_have_url(re.compile(r"#/scans/[0-9a-f-]{36}$"))
            expect(page.get_by_role("progressbar")).to_be_visible()
            expect(page.get_by_alt_text("Bild 2")).to_be_visible()
            sound(page)
        expect(page.locator('[data-fit][aria-busy="false"]')).to_be_attached(timeout=FIT_WITHIN_MS)
        visitor.choose("Foto")
        expect(page.get_by_role("radio", name="Von der Seite", exact=True)).to_be_attached()
        visitor.choose("Körper")
        expect(page.get_by_text("Alle Punkte wurden automatisch gefunden")).to_be_visible()
        expect(page.get_by_role("row", name=re.compile("^Gewicht"))).to_contain_text(
            re.compile(r"\d,\d.*\d,\d – \d+,\d")
        )
        open_folds(page)
        sound(page)
        assert serious_findings(page, axe) == []
        page.get_by_role("button", name="Diesen Scan löschen").click()
        sound(page)
        page.get_by_role("button", name="Behalten").click()

        page.get_by_role("radio", name="Konfektionsgröße").check()
        expect(page.get_by_text("Größentabellen sind in cm")).to_be_visible()
        for label, chest in {"S": "76,5-82", "M": "82-90", "L": "91-98"}.items():
            page.get_by_label(f"{label}: Brust").fill(chest)
        page.get_by_role("button", name="Größe bestimmen").click()
        made = page.locator(".derived")
        expect(made).to_contain_text("Größe M", timeout=FIT_WITHIN_MS)
        expect(made).to_contain_text(re.compile(r"\d,\d ± \d,\d cm: .* spricht für"))
        expect(made).to_contain_text("Zwischen manchen Größen der Tabelle ist eine Lücke")
        sound(page)
        assert serious_findings(page, axe) == []
        visitor.unfold_for_experts()
        visitor.choose("Wie im Bild")
        expect(visitor.body).to_have_attribute("data-shows", re.compile("^turned clay"))
        sound(page)


def test_what_is_wrong_with_a_picture_is_said_in_german(browser: Browser, service: httpx.Client):
    with Visitor.at(browser, str(service.base_url), PHONE | GERMAN) as visitor:
        page = visitor.page
        page.goto(f"{visitor.origin}/#/scans/00000000-0000-0000-0000-000000000000")
        expect(page.get_by_role("heading", name="Diesen Scan gibt es nicht mehr")).to_be_visible()
        assert english_left(page, of_at_least=5) == []
        page.get_by_role("button", name="Jemanden messen").tap()
        side = page.locator('[data-place="side"]')
        side.locator("input[type=file]").set_input_files(DATA / "scan_front.jpg")
        expect(side.locator('[data-code="other-view"]')).to_contain_text("Bitte neu aufnehmen")
        expect(side).to_contain_text("Von der Seite: um ein Viertel gedreht")
        sound(page)
        # No camera is there.
        side.get_by_role("button", name="Neu aufnehmen").tap()
        camera = page.get_by_role("dialog", name="Kamera: Bild von der Seite")
        expect(camera.get_by_role("alert")).to_contain_text("Wählen Sie stattdessen eine Datei")
        expect(camera.get_by_role("button", name="In 5 s aufnehmen")).to_be_disabled()
        sound(page)
