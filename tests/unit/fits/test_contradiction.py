"""What figures of a fit contradict a person, and which ones never do."""

from dataclasses import replace

import pytest

from fitter.fits.plausibility import Plausibility
from fitter.fits.verdict import contradiction
from fitter.result import VERDICT_EXPLANATIONS
from fitter.vocabulary.outcomes import Verdict
from fitter.vocabulary.remarks import Code, Severity

PERSON = Plausibility(
    overlap=0.94,
    boundary=0.93,
    beyond=0.0,
    outgrown_m=0.0,
    click_deviations=0.6,
    strain=6.0,
    clothed=False,
    detected=None,
)
LANDSCAPE = replace(PERSON, overlap=0.8, boundary=0.09)
LANDSCAPE_AS_CLOTHES = replace(PERSON, overlap=0.89, boundary=0.12, clothed=True)
DOG = replace(PERSON, overlap=0.82, boundary=0.7, click_deviations=2.2, strain=34.0)
TWO_IN_ONE_MASK = replace(PERSON, overlap=0.5, beyond=0.84)
PERMUTED = replace(PERSON, overlap=0.83, boundary=0.4, click_deviations=4.6)


@pytest.mark.parametrize(
    "changes",
    [
        {},
        {"overlap": 0.87, "boundary": 0.17},
        {"overlap": 0.68, "boundary": 0.56},
        {"overlap": 0.81, "boundary": 0.35},
        {"click_deviations": 3.3, "strain": 11.0, "overlap": 0.83},
        {"strain": 26.0, "overlap": 0.88, "boundary": 0.67},
    ],
    ids=["usual", "in the dark", "behind a table", "in grain", "careless points", "athlete"],
)
@pytest.mark.parametrize("detected", [None, True])
def test_hard_pictures_of_people_contradict_nobody(changes, detected):
    assert contradiction(replace(PERSON, detected=detected, **changes)).verdict is Verdict.PLAUSIBLE


def test_that_the_detector_finds_nobody_decides_nothing_alone():
    dark = replace(PERSON, overlap=0.92, boundary=0.17, detected=False)
    table = replace(PERSON, overlap=0.75, boundary=0.57, detected=False)
    verdicts = [contradiction(each).verdict for each in (dark, table)]
    assert verdicts == [Verdict.PLAUSIBLE, Verdict.PLAUSIBLE]


@pytest.mark.parametrize("detected", [None, False])
def test_where_neither_silhouette_nor_outline_are_a_person_s_there_is_none(detected):
    found = contradiction(replace(LANDSCAPE, detected=detected))
    assert found.verdict is Verdict.NO_PERSON
    (finding,) = found.findings
    assert "9%" in finding.reason
    assert "80%" in finding.reason


def test_a_person_whom_the_detector_sees_is_never_nobody():
    for each in (LANDSCAPE, LANDSCAPE_AS_CLOTHES, DOG, TWO_IN_ONE_MASK, PERMUTED):
        verdict = contradiction(replace(each, detected=True)).verdict
        assert verdict is not Verdict.NO_PERSON
    assert contradiction(replace(LANDSCAPE_AS_CLOTHES, detected=True)).verdict is Verdict.PLAUSIBLE
    assert contradiction(replace(LANDSCAPE, detected=True)).verdict is Verdict.PLAUSIBLE


@pytest.mark.parametrize(
    ("found", "said"),
    [
        (DOG, "that people hardly have"),
        (TWO_IN_ONE_MASK, "84% of its size"),
        (PERMUTED, "4.6 standard deviations"),
        (replace(PERSON, overlap=0.13), "overlap by 13%"),
    ],
    ids=["dog", "two in one mask", "permuted", "another mask"],
)
def test_a_body_that_is_contradicted_is_implausible_and_told_by_what(found, said):
    judged = contradiction(found)
    assert judged.verdict is Verdict.IMPLAUSIBLE
    (finding,) = judged.findings
    assert (finding.code, finding.severity) == (Code.CONTRADICTED, Severity.BLOCKS)
    assert said in finding.reason
    assert finding.remedy


def test_the_detector_tells_noise_of_good_outline_from_a_person():
    noise = replace(PERSON, overlap=0.84, boundary=0.4)
    verdicts = [contradiction(replace(noise, detected=each)).verdict for each in (None, False)]
    assert verdicts == [Verdict.PLAUSIBLE, Verdict.NO_PERSON]


def test_clothes_that_fit_any_outline_are_no_person_s_where_the_detector_finds_nobody():
    circle = replace(PERSON, overlap=0.9, boundary=0.26, clothed=True)
    verdicts = [contradiction(replace(circle, detected=each)).verdict for each in (True, False)]
    assert verdicts == [Verdict.PLAUSIBLE, Verdict.NO_PERSON]


def test_every_contradicted_verdict_explains_itself():
    assert {*VERDICT_EXPLANATIONS, Verdict.PLAUSIBLE} == set(Verdict)


def test_an_unusual_person_is_no_covered_one_and_is_not_measured():
    found = contradiction(replace(PERSON, outgrown_m=0.085))
    assert found.verdict is Verdict.IMPLAUSIBLE
    (finding,) = found.findings
    assert finding.severity is Severity.BLOCKS
    assert "8 cm outside" in finding.reason
    assert "tape" in finding.remedy


@pytest.mark.parametrize("reached_m", [0.0, 0.015, 0.035])
def test_what_the_model_hardly_misses_contradicts_nobody(reached_m):
    assert contradiction(replace(PERSON, outgrown_m=reached_m)).verdict is Verdict.PLAUSIBLE
