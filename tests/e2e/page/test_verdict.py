"""The points of a person on a landscape: what is withheld, and how one insists on the page."""

import json

import httpx
import pytest
from playwright.sync_api import expect

from fitter.vocabulary.choices import Cues
from tests.e2e.page.visitor import FIT_WITHIN_MS, Visitor
from tests.e2e.service import ended_job
from tests.integration.nonsense import nonsense


@pytest.fixture(scope="module")
def fit_of_hills(service: httpx.Client) -> dict:
    asked = nonsense(Cues.SES)["landscape"]
    (view,) = asked.views
    request = {
        "gender": asked.person.gender,
        "height_m": asked.person.height_m,
        "views": [
            {"points": {name: {"x": each.x, "y": each.y} for name, each in view.clicks.items()}}
        ],
    }
    files = {
        "image": ("hills.jpg", view.image, "image/jpeg"),
        "request": ("request.json", json.dumps(request), "application/json"),
    }
    return ended_job(service, service.post("/v1/fits", files=files))


def test_a_landscape_is_fitted_and_not_measured(service: httpx.Client, fit_of_hills: dict):
    assert fit_of_hills["state"] == "succeeded"
    result = service.get(fit_of_hills["links"]["result"]).raise_for_status().json()
    assert (result["views"][0]["outcome"], result["verdict"]) == ("poor_fit", "no_person")
    assert result["measurements"] == []
    assert "views/0/overlay.png" in fit_of_hills["links"]["files"]
    path = fit_of_hills["links"]["self"]
    table = service.get(f"{path}/files/measurements.csv").raise_for_status().text
    assert table.count("\n") == 1


def test_the_page_says_that_nobody_is_there_and_measures_anyway(
    visitor: Visitor, fit_of_hills: dict
):
    page = visitor.page
    page.goto(f"{visitor.origin}/#/fits/{fit_of_hills['id']}")
    expect(page.get_by_role("heading", name="No person found")).to_be_visible()
    expect(page.locator("p.note.is-problem")).to_contain_text("No person is seen")
    expect(page.locator(".measures")).to_have_count(0)
    page.get_by_role("button", name="Measure anyway").click()
    expect(page.locator(".measures").first).to_be_visible(timeout=FIT_WITHIN_MS)
    expect(page.get_by_role("heading", name="No person found")).to_be_visible()
    expect(page.get_by_text("You asked for measurements all the same")).to_be_visible()
