"""Sizes, body fat and changes: what follows from measurements, as derivations."""

import csv
import io
from dataclasses import replace

import numpy as np
import pytest

from fitter.body.storage import load_body_model, packaged_model_path
from fitter.fits.prepared_model import prepared_model
from fitter.measurement.anthropometry import measure
from fitter.vocabulary.choices import Gender
from service.jobs.inputs import (
    CHART,
    PERSON,
    RESULT,
    of_other,
)
from service.worker.pipeline_port import (
    UnusableInputError,
)
from tests.unit.service.derivation_samples import (
    CHART_CSV,
    FITS,
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
    table = list(csv.DictReader(io.StringIO(output.artifacts["sizes.csv"].decode())))
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


def changed_person(**shifts: float) -> dict[str, bytes]:
    """The other fit of a comparison, with some coefficients shifted."""
    someone = person()
    shape = someone.body.shape.copy()
    for index, shift in shifts.items():
        shape[int(index.removeprefix("b"))] += shift
    other = replace(someone, body=replace(someone.body, shape=shape))
    return {of_other(PERSON, 0): other.to_bytes()}


def test_the_same_fit_twice_has_changed_in_nothing():
    result = derived(kind="change", since=FITS[0]).result.model_dump()
    assert {each["difference"] for each in result["changes"]} == {0.0}
    assert not any(each["is_change"] for each in result["changes"])
    assert result["warnings"] == ()


def test_a_large_difference_is_a_change_and_a_small_one_is_none():
    small, large = (
        derived(kind="change", since=FITS[0], files=changed_person(b1=shift)).result.model_dump()
        for shift in (-0.05, -5.0)
    )
    assert not any(each["is_change"] for each in small["changes"])
    called = {each["name"] for each in large["changes"] if each["is_change"]}
    assert "weight" in called
    for each in large["changes"]:
        assert each["difference"] == pytest.approx(each["after"] - each["before"], abs=0.021)


def test_fewer_measurements_are_compared_by_a_smaller_least_difference():
    names = ["waist_girth_navel", "weight"]
    everything = derived(kind="change", since=FITS[0]).result.model_dump()["changes"]
    chosen = derived(kind="change", since=FITS[0], measurements=names).result.model_dump()
    assert [each["name"] for each in chosen["changes"]] == names
    least = {each["name"]: each["least"] for each in everything}
    for each in chosen["changes"]:
        assert each["least"] < least[each["name"]]


def test_a_change_of_height_is_remarked_on():
    (warning,) = derived(
        kind="change", since=FITS[0], files=changed_person(b0=1.0)
    ).result.model_dump()["warnings"]
    assert warning["code"] == "heights-differ"


@pytest.mark.parametrize("kind", ["size", "body_composition", "change"])
def test_nothing_follows_from_measurements_that_are_withheld(kind):
    withheld = fit_result(light=None, reflectance=None, measurements=())
    files = {RESULT: withheld.model_dump_json().encode()}
    with pytest.raises(UnusableInputError) as caught:
        derived(kind=kind, files=files, **NEEDED.get(kind, {}))
    assert (caught.value.error.code, caught.value.error.field) == ("fits-unusable", "kind")


def test_a_fit_of_another_gender_is_nobody_s_earlier_one():
    model = load_body_model(packaged_model_path("male"))
    man = replace(person(), gender=Gender.MALE, model_checksum=str(model.header["checksum"]))
    with pytest.raises(UnusableInputError) as caught:
        derived(kind="change", since=FITS[0], files={of_other(PERSON, 0): man.to_bytes()})
    assert (caught.value.error.code, caught.value.error.field) == ("fits-unusable", "since")


@pytest.mark.parametrize("kind", ["size", "change", "combined"])
def test_of_a_fit_by_the_papers_method_which_states_no_errors_the_remedy_is_another_fit(kind: str):
    unsure = replace(person(), shape_covariance=None).to_bytes()
    with pytest.raises(UnusableInputError) as caught:
        derived(kind=kind, files={PERSON: unsure}, **NEEDED[kind])
    assert caught.value.error.code == "fits-unusable"
    assert "without `paper`" in caught.value.error.remedy
