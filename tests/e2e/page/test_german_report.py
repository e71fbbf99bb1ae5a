"""Who reads the page in German gets the report in German."""

import httpx
from playwright.sync_api import Browser, expect

from tests.e2e.page.visitor import FIT_WITHIN_MS, Visitor


def test_the_report_speaks_the_page_s_language(
    browser: Browser, service: httpx.Client, bare_fit: str
):
    with Visitor.at(browser, str(service.base_url), locale="de-DE") as visitor:
        page = visitor.page
        page.goto(f"{visitor.origin}/#/fits/{bare_fit}")
        visitor.wait_for_result()
        visitor.choose("Bericht")
        # The page may be asking for the skin meanwhile.
        with page.expect_request(lambda sent: '"report"' in (sent.post_data or "")) as sent:
            page.get_by_role("button", name="Bericht erstellen").click()
        assert sent.value.post_data_json["language"] == "de"
        made = page.locator(".derived > li")
        expect(made.get_by_role("button", name="report.pdf")).to_be_visible(timeout=FIT_WITHIN_MS)
    made = service.get(f"/v1/fits/{bare_fit}/derivations").json()["derivations"]
    (job,) = (each for each in made if each["kind"] == "report")
    report = service.get(job["links"]["artifacts"]["report.html"]).text
    assert '<html lang="de">' in report
    assert "Taillenumfang am Nabel" in report
    # The tapes the fit laid are drawn.
    assert report.count("<circle") > 15
