"""What follows from a fit's measurements: sizes and body fat."""

import json
from typing import Any

import httpx
import pytest

from tests.integration.service.harness import Service
from tests.integration.service.test_derivations import derived, fitted, post, problem

CHART = "size,chest_girth,waist_girth_navel\nM,94-98,80-84\nL,98-102,84-88\n"


def post_chart(
    service: Service, fit: str, chart: str | bytes = CHART, **request: object
) -> httpx.Response:
    form: dict[str, Any] = {
        "files": {"chart": ("chart.csv", chart, "text/csv")},
        "data": {"request": json.dumps({"kind": "size"} | request)},
    }
    return service.client.post(f"{fit}/derivations", **form)


def test_a_size_is_answered_for_a_chart_beside_the_request_or_in_it(either: Service):
    service = either
    fit = fitted(service)
    answers = (
        post_chart(service, fit, ease={"waist_girth_navel": 2}),
        post(service, fit, {"kind": "size", "chart_csv": CHART}),
        post(
            service,
            fit,
            {
                "kind": "size",
                "chart": {"sizes": [{"label": "M", "measurements": {"hip_girth": 98}}]},
                "tolerances": {"hip_girth": {"too_small": 2, "too_large": 4}},
            },
        ),
    )
    for answer in answers:
        assert answer.status_code == 202, answer.text
        job = service.ended(answer.headers["Location"])
        assert (job["state"], job["kind"]) == ("succeeded", "size")
        result = service.client.get(job["links"]["result"]).json()
        # The example's figures are rounded.
        shares = [each["probability"] for each in result["sizes"]]
        assert sum(shares) + result["none_fits"] == pytest.approx(1.0, abs=1e-3)
        table = service.client.get(job["links"]["artifacts"]["sizes.csv"])
        assert table.headers["content-type"].partition(";")[0] == "text/csv"
        assert table.text.startswith("label,probability")
        asked = service.client.get(job["links"]["request"]).json()
        assert asked["kind"] == "size"
        again = service.client.post(job["links"]["retry"]).raise_for_status()
        assert service.ended(again.headers["Location"])["state"] == "succeeded"


@pytest.mark.parametrize(
    ("chart", "request_", "fault"),
    [
        ("", {}, (422, "no-sizes", "chart")),
        ("size,waist\nM,80-84\n", {}, (422, "unknown-value", "chart")),
        (CHART + "M,90-94,\n", {}, (422, "repeated", "chart")),
        (b"\xff\xfe", {}, (422, "not-a-table", "chart")),
        (CHART + "," * 300_000, {}, (413, "payload-too-large", "chart")),
        (CHART, {"ease": {"hip_girth": 1}}, (422, "unknown-value", "ease.hip_girth")),
        (
            "size,head_girth\nS,57\nM,57\n",
            {},
            (422, "tolerance-needed", "tolerances.head_girth"),
        ),
        (CHART, {"chart_csv": CHART}, (422, "unknown-field", "chart")),
        (CHART, {"kind": "pose"}, (422, "unknown-field", "chart")),
    ],
)
def test_a_chart_at_fault_is_refused_before_anything_is_queued(
    service: Service, chart: str | bytes, request_: dict[str, object], fault: tuple
):
    fit = fitted(service)
    assert problem(post_chart(service, fit, chart, **request_)) == fault
    assert service.client.get(f"{fit}/derivations").json()["derivations"] == []


def test_a_size_needs_a_chart(service: Service):
    assert problem(post(service, fitted(service), {"kind": "size"})) == (422, "missing", "chart")


def test_a_bad_cell_is_named_by_row_and_column(service: Service):
    answer = post_chart(service, fitted(service), CHART + "XL,102-106,92-88\n").json()
    assert "Row 4 ('XL'), column 'waist_girth_navel'" in answer["errors"][0]["reason"]
    unknown = {"sizes": [{"label": "M", "measurements": {"bust": 90}}]}
    answer = post(service, fitted(service), {"kind": "size", "chart": unknown}).json()
    assert answer["field"] == "chart.sizes.0.measurements.bust"
    assert "chest_girth" in answer["remedy"]


def test_body_composition_is_answered(service: Service):
    fit = fitted(service)
    job = service.ended(derived(service, fit, {"kind": "body_composition", "age_years": 40}))
    assert job["state"] == "succeeded"
    result = service.client.get(job["links"]["result"]).json()
    assert result["estimates"][0]["name"] == "us_navy"
    for age in (-1, 121, "40"):
        answer = post(service, fit, {"kind": "body_composition", "age_years": age})
        assert problem(answer)[::2] == (422, "age_years")
