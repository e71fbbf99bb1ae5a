"""The points of a person on a landscape: what is withheld, and how one insists on the page."""

import json

import httpx
import pytest
from playwright.sync_api import expect

from fitter.vocabulary.choices import Cues
from tests.e2e.page.visitor import FIT_WITHIN_MS, Visitor
from tests.e2e.service import ended_job
from tests.evaluation.nonsense import nonsense
from tests.evaluation.scene import Half


@pytest.fixture(scope="module")
def fit_of_hills(service: httpx.Client) -> dict:
    asked = nonsense(Half.TUNING, Cues.SES, count=1)[0].request
    (view,) = asked.views
    request = {
        "gender": asked.person.gender,
        "height_m": asked.person.height_m,
        "points": {name: {"x": each.x, "y": each.y} for name, each in view.clicks.items()},
    }
    files = {
        "image": ("hills.jpg", view.image, "image/jpeg"),
        "request": ("request.json", json.dumps(request), "application/json"),
    }
    return ended_job(service, service.post("/v1/fits", files=files))


def test_a_landscape_is_fitted_and_not_measured(service: httpx.Client, fit_of_hills: dict):
    assert fit_of_hills["state"] == "succeeded"
    result = service.get(fit_of_hills["links"]["result"]).raise_for_status().json()
    assert (result["outcome"], result["verdict"]) == ("poor_fit", "no_person")
    assert result["measurements"] == []
    assert all(stage["measurements"] == [] for stage in result["stages"])
    assert {"body_posed.glb", "overlay.png"} <= fit_of_hills["links"]["artifacts"].keys()
    path = fit_of_hills["links"]["self"]
    table = service.get(f"{path}/artifacts/measurements.csv").raise_for_status().text
    assert table.count("\n") == 1


def test_derivations_that_need_measurements_say_that_there_are_none(
    service: httpx.Client, fit_of_hills: dict, finished_fit: str
):
    path = f"{fit_of_hills['links']['self']}/derivations"
    report = ended_job(service, service.post(path, json={"kind": "report"}))
    page = service.get(report["links"]["artifacts"]["report.html"]).raise_for_status().text
    assert "No measurements are given" in page
    combined = ended_job(
        service, service.post(path, json={"kind": "combined", "fits": [finished_fit]})
    )
    assert combined["state"] == "failed"
    (error,) = combined["problem"]["errors"]
    assert (error["code"], error["field"]) == ("fits-unusable", "kind")
    assert "withheld" in error["reason"]


def test_the_page_says_that_nobody_is_there_and_measures_anyway(
    visitor: Visitor, fit_of_hills: dict
):
    page = visitor.page
    page.goto(f"{visitor.origin}/#/fits/{fit_of_hills['id']}")
    expect(page.get_by_role("heading", name="No person found")).to_be_visible()
    # What was tried with the fit before may have failed, and says so in a note of its own.
    expect(page.locator("p.note.is-problem")).to_contain_text("overlap")
    expect(page.locator(".measures")).to_have_count(0)
    page.get_by_role("button", name="Measure anyway").click()
    expect(page.locator(".measures").first).to_be_visible(timeout=FIT_WITHIN_MS)
    expect(page.get_by_role("heading", name="No person found")).to_be_visible()
    expect(page.get_by_text("You asked for measurements all the same")).to_be_visible()
