"""People on the page: a name goes with a fit, and all of a person is found, compared and erased."""

import json
import re
from urllib.parse import quote
from uuid import uuid4

import httpx
import pytest
from playwright.sync_api import Browser, Locator, Page, expect

from service.demo_data.sample import load_sample
from tests.e2e.page.test_for_everyone import axe, serious_findings
from tests.e2e.page.test_german import OVERFLOWING, english_left
from tests.e2e.page.visitor import DESK, FIT_WITHIN_MS, PHONE, Visitor
from tests.e2e.service import ended_job

__all__ = ["axe"]

NAME = "Name for this person, if you like"


def name_field(page: Page) -> Locator:
    """Where the person is named, unfolded."""
    page.locator("summary").filter(has_text=re.compile(r"^Name\b")).click()
    return page.get_by_label(NAME)


def a_name() -> str:
    """One that no other test has, with what addresses must escape."""
    return f"Zoë & Groß 100 % #{uuid4().hex[:6]}"


def fitted(service: httpx.Client, label: str, **told: object) -> str:
    """The id of a fit of the sample by its outline, which has succeeded."""
    sample = load_sample()
    asked = json.loads(sample.request) | {"cues": "SE", "label": label} | told
    files = {
        "image": ("sample.jpg", sample.image, "image/jpeg"),
        "request": ("request.json", json.dumps(asked), "application/json"),
    }
    job = ended_job(service, service.post("/v1/fits", files=files))
    assert job["state"] == "succeeded"
    return job["id"]


@pytest.fixture(scope="module")
def person(service: httpx.Client) -> tuple[str, str, str]:
    """Somebody of two fits, told 72 and then 88 kg: the name, and the ids."""
    label = a_name()
    return label, *(fitted(service, label, weight_kg=weight) for weight in (72.0, 88.0))


def look_at(visitor: Visitor, label: str) -> None:
    visitor.page.goto(f"{visitor.origin}/#/people/{quote(label, safe='')}")
    expect(visitor.page.locator("main.person-page")).to_have_attribute("aria-busy", "false")


def test_a_name_is_sent_with_its_picture_and_forgotten_with_it(
    visitor: Visitor, person: tuple[str, str, str]
):
    page = visitor.page
    visitor.open_sample(with_points=True)
    name = name_field(page)
    name.focus()
    suggested = page.locator(f"datalist option[value={json.dumps(person[0], ensure_ascii=False)}]")
    expect(suggested).to_have_count(1)
    label = a_name()
    name.fill(f" {label} ")
    assert visitor.sent_request()["label"] == label
    visitor.wait_for_result()
    page.get_by_role("button", name="Correct something").click()
    visitor.wait_for_stage()
    expect(name).to_have_value(label)
    sample = {"name": "b.jpg", "mimeType": "image/jpeg", "buffer": load_sample().image}
    page.locator("input[type=file]").first.set_input_files(sample)
    expect(name).to_have_value("")
    visitor.wait_for_stage()
    visitor.describe_person()
    assert "label" not in visitor.sent_request()


def test_a_scan_is_named_and_another_picture_is_of_somebody_new(visitor: Visitor):
    page = visitor.page
    page.get_by_role("link", name="Measure", exact=True).click()
    page.get_by_role("button", name="Try the sample pair").click()
    name_field(page).fill(label := a_name())
    measure = page.get_by_role("button", name="Measure", exact=True)
    expect(measure).to_be_enabled()
    with page.expect_response("**/v1/scans") as sent:
        measure.click()
    assert sent.value.request.post_data_json["label"] == label
    assert sent.value.json()["label"] == label
    page.get_by_role("link", name="Measure", exact=True).click()
    expect(page.get_by_label(NAME)).to_have_value(label)
    sample = {"name": "b.jpg", "mimeType": "image/jpeg", "buffer": load_sample().image}
    page.locator("[data-place=front] input[type=file]").first.set_input_files(sample)
    # Of whoever was measured nothing is left: not the height, nor the other picture.
    expect(page.get_by_label(NAME)).to_have_value("")
    expect(page.get_by_label("Height", exact=True)).to_have_value("")
    expect(page.locator("[data-place=side] .place-picture img")).to_have_count(0)


def test_changes_are_drawn_and_told_with_their_uncertainty(
    visitor: Visitor, service: httpx.Client, person: tuple[str, str, str]
):
    label, _, later = person
    page = visitor.page
    look_at(visitor, label)
    expect(page.get_by_role("heading", name=label)).to_be_visible()
    expect(page.get_by_text("2 fits", exact=True)).to_be_visible()
    chart = page.locator("[data-measure=weight]")
    expect(chart.locator(".time-point")).to_have_count(2)
    rows = chart.get_by_role("row")
    expect(rows.nth(1)).to_contain_text("72.0 kg")
    expect(rows.nth(2)).to_contain_text("88.0 kg")
    beyond = page.locator(".change-list:not(.is-within) li")
    weight = beyond.filter(has_text="Weight: 16.0 kg more")
    expect(weight).to_have_count(1, timeout=FIT_WITHIN_MS)
    told = page.locator(".change-list li")
    expect(told).to_have_count(8)
    # As the service has it, which was asked once.
    derivations = f"/v1/fits/{later}/derivations"
    (made,) = service.get(derivations).json()["derivations"]
    changes = service.get(made["links"]["result"]).json()["changes"]
    expect(beyond).to_have_count(sum(each["is_change"] for each in changes))
    page.reload()
    expect(weight).to_have_count(1)
    assert len(service.get(derivations).json()["derivations"]) == 1


def test_charts_are_chosen_and_units_change(visitor: Visitor, person: tuple[str, str, str]):
    page = visitor.page
    look_at(visitor, person[0])
    charts = page.locator(".time-chart")
    expect(charts).to_have_count(3)
    page.get_by_label("Neck", exact=True).check()
    expect(charts).to_have_count(4)
    page.get_by_label("Weight", exact=True).uncheck()
    expect(page.locator("[data-measure=weight]")).to_have_count(0)
    # An interval's bar goes from its low end to its high one.
    bar = page.locator("[data-measure=neck_girth] .time-point path").first
    assert bar.evaluate("path => path.getBBox().height") > 5
    page.get_by_label("Weight", exact=True).check()
    visitor.choose("in, lb")
    expect(page.locator("[data-measure=weight]").get_by_role("row").nth(1)).to_contain_text(
        "158.7 lb"
    )


def test_the_list_shows_one_person_s_and_leads_to_all_of_them(
    visitor: Visitor, person: tuple[str, str, str], finished_fit: str
):
    page = visitor.page
    label, earlier, _ = person
    for each in (earlier, finished_fit):
        page.goto(f"{visitor.origin}/#/fits/{each}")
        visitor.wait_for_result()
    page.get_by_role("button", name="Fits").click()
    listed = page.get_by_role("dialog").locator(".history li")
    expect(listed).to_have_count(2)
    page.get_by_label("Whose").select_option(label=label)
    expect(listed).to_have_count(1)
    expect(listed).to_contain_text(label)
    page.get_by_role("link", name="Changes over time").click()
    expect(page.get_by_role("dialog")).to_have_count(0)
    expect(page.get_by_role("heading", name=label)).to_be_visible()


def test_all_of_a_person_is_erased_once_it_is_asked_twice(visitor: Visitor, service: httpx.Client):
    page = visitor.page
    label = a_name()
    for _ in range(2):
        fitted(service, label)
    kept = fitted(service, a_name())
    look_at(visitor, label)
    page.get_by_role("button", name=f"Delete everything of {label}").click()
    expect(page.get_by_text("Delete 2 fits, with pictures")).to_be_visible()
    page.get_by_role("button", name="Keep").click()
    assert len(service.get("/v1/fits", params={"label": label}).json()["jobs"]) == 2
    page.get_by_role("button", name=f"Delete everything of {label}").click()
    page.get_by_role("button", name="Delete", exact=True).click()
    expect(page.locator("main.person-page")).to_have_count(0)
    assert service.get("/v1/fits", params={"label": label}).json()["jobs"] == []
    assert service.get(f"/v1/fits/{kept}").status_code == httpx.codes.OK
    look_at(visitor, label)
    expect(page.get_by_text("Nothing is kept of this person.")).to_be_visible()


@pytest.mark.parametrize(
    ("device", "theme"), [(PHONE, "dark"), (DESK, "light")], ids=["phone, dark", "desk, light"]
)
def test_in_german_it_is_whole_and_for_everyone(
    browser: Browser,
    service: httpx.Client,
    person: tuple[str, str, str],
    axe: str,
    device: dict,
    theme: str,
):
    german = {"locale": "de-DE", "color_scheme": theme}
    with Visitor.at(browser, str(service.base_url), device, **german) as visitor:
        look_at(visitor, person[0])
        page = visitor.page
        expect(page.locator(".change-list li")).to_have_count(8, timeout=FIT_WITHIN_MS)
        expect(page.get_by_text("Gewicht: 16,0 kg mehr")).to_be_visible()
        page.get_by_role("button", name=f"Alles von {person[0]} löschen").click()
        assert english_left(page) == []
        assert page.evaluate(OVERFLOWING) == []
        assert serious_findings(page, axe) == []
