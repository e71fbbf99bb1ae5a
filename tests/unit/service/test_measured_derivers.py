"""Sizes and body fat: what follows from measurements, as derivations."""

import csv
import io
from dataclasses import replace

import numpy as np
import pytest

from fitter.fits.prepared_model import prepared_model
from fitter.measurement.anthropometry import measure
from fitter.vocabulary.choices import Gender
from service.jobs.inputs import (
    CHART,
    PERSON,
    RESULT,
)
from service.worker.pipeline_port import (
    UnusableInputError,
)
from tests.unit.service.derivation_samples import (
    CHART_CSV,
    NEEDED,
    derived,
    person,
)
from tests.unit.service.fit_results import fit_result


def test_a_size_follows_from_a_chart_in_the_request_or_beside_it():
    inline = derived(kind="size", chart_csv=CHART_CSV).result
    beside = derived(kind="size", files={CHART: CHART_CSV.encode()}).result
    sizes = [
        {
            "label": label,
            "measurements": {
                "chest_girth": {"low": chest, "high": chest + 10},
                "waist_girth_navel": {"low": waist, "high": waist + 10},
            },
        }
        for label, chest, waist in (("S", 80, 70), ("M", 90, 80), ("L", 100, 90))
    ]
    spelled_out = derived(kind="size", chart={"sizes": sizes}).result
    assert inline == beside == spelled_out
    result = inline.model_dump()
    chances = [each["probability"] for each in result["sizes"]]
    assert sum(chances) + result["none_fits"] == pytest.approx(1.0)
    assert [each["name"] for each in result["arguments"]] == ["chest_girth", "waist_girth_navel"]
    assert result["recommended"] == result["sizes"][int(np.argmax(chances))]["label"]


def test_the_table_of_sizes_says_what_the_result_does():
    output = derived(kind="size", chart_csv=CHART_CSV)
    table = list(csv.DictReader(io.StringIO(output.files["sizes.csv"].decode())))
    sizes = output.result.model_dump()["sizes"]
    assert [each["label"] for each in table] == ["S", "M", "L"]
    assert [float(each["probability"]) for each in table] == [each["probability"] for each in sizes]


def test_ease_and_gaps_of_a_chart_reach_the_answer():
    gaps = CHART_CSV.replace("80-90,70-80", "80-89,70-79")
    result = derived(kind="size", chart_csv=gaps, ease={"chest_girth": 12}).result.model_dump()
    assert {each["code"] for each in result["warnings"]} == {"chart-gap"}
    assert result["arguments"][0]["ease"] == pytest.approx(12.0)
    plain = derived(kind="size", chart_csv=gaps).result.model_dump()
    assert result["sizes"] != plain["sizes"]


def test_standard_errors_of_what_follows_are_those_of_the_measurements():
    result = derived(kind="size", chart_csv=CHART_CSV).result.model_dump()
    prepared = prepared_model(Gender.FEMALE)
    someone = person()
    measured = measure(
        prepared.measuring, someone.body.shape, shape_covariance=someone.shape_covariance
    )
    found = {each.name: each for each in measured}
    for each in result["arguments"]:
        of_fit = found[each["name"]]
        assert each["value"] == pytest.approx(of_fit.value, abs=0.011)
        assert each["standard_error"] == pytest.approx(of_fit.standard_error, abs=0.0011)


def test_body_fat_says_why_it_is_withheld_for_the_young():
    adult, child = (
        derived(kind="body_composition", age_years=age).result.model_dump() for age in (30, 12)
    )
    assert [each["name"] for each in adult["estimates"]] == ["us_navy", "cun_bae"]
    for each in adult["estimates"]:
        assert 5.0 < each["percent"] < 60.0
        assert each["standard_error"] > each["regression_error"]
    assert [each["percent"] for each in child["estimates"]] == [None, None]
    assert all("years, not of 12" in each["withheld"][0] for each in child["estimates"])


@pytest.mark.parametrize("kind", ["size", "body_composition"])
def test_nothing_follows_from_measurements_that_are_withheld(kind):
    withheld = fit_result(measurements=())
    files = {RESULT: withheld.model_dump_json().encode()}
    with pytest.raises(UnusableInputError) as caught:
        derived(kind=kind, files=files, **NEEDED.get(kind, {}))
    assert (caught.value.error.code, caught.value.error.field) == ("fits-unusable", "kind")


def test_of_a_fit_by_the_papers_method_which_states_no_errors_the_remedy_is_another_fit():
    unsure = replace(person(), shape_covariance=None).to_bytes()
    with pytest.raises(UnusableInputError) as caught:
        derived(kind="size", files={PERSON: unsure}, **NEEDED["size"])
    assert caught.value.error.code == "fits-unusable"
    assert "without `paper`" in caught.value.error.remedy
