"""Fits of pictures without a person to measure: what is told, and what is withheld."""

import pytest

from fitter.fits.pipeline import fit
from fitter.request import FitRequest, Person, View
from fitter.result import FitResult
from fitter.vocabulary.choices import Cues, Gender, SegmentationKind, ViewKind
from fitter.vocabulary.outcomes import Outcome, Verdict
from fitter.vocabulary.remarks import Code, Severity
from tests.accuracy.cases import CASES
from tests.accuracy.files import read_case
from tests.accuracy.true_picture import fit_request
from tests.integration.nonsense import DONORS, nonsense
from tests.one_picture import changed
from tests.shared_data import SHARED_DATA, needs_shared

MADE = nonsense(Cues.SE)

NAMED_KINDS = ("landscape", "circle", "two in one mask")
"""Kinds that must be recognised; landscapes without a detector too."""


def fitted(kind: str, *, with_detector: bool = False, force: bool = False) -> FitResult:
    return fit(
        changed(
            MADE[kind],
            force=force,
            segmentation=SegmentationKind.SEEDED_GRABCUT
            if with_detector
            else SegmentationKind.GRABCUT,
            slant_hints=with_detector,
        )
    )


@pytest.mark.slow
@pytest.mark.parametrize(
    ("kind", "with_detector"), [*((each, True) for each in NAMED_KINDS), ("landscape", False)]
)
def test_what_is_no_person_gets_no_measurements(kind, with_detector):
    result = fitted(kind, with_detector=with_detector)
    assert not result.found.is_plausible
    blocking = {each.code for each in result.found.findings if each.severity is Severity.BLOCKS}
    assert Code.CONTRADICTED in blocking
    assert "contradicted: " in result.found.outcome_explanation
    assert result.measurements == ()
    assert all(stage.measurements == () for stage in result.stages)
    assert len(result.found.posed_vertices)
    assert (result.found.verdict is Verdict.NO_PERSON) == (kind != "two in one mask")
    assert result.found.outcome is Outcome.POOR_FIT


@pytest.mark.slow
def test_noise_that_points_are_put_on_is_said_to_show_nobody():
    # Its colours change everywhere, so that the evidence alone contradicts nothing.
    result = fitted("noise", with_detector=True)
    (found,) = [each for each in result.found.findings if each.code == Code.NOBODY_FOUND]
    assert found.severity is Severity.HARMS
    assert {each.code for each in result.found.findings} > {Code.NOBODY_FOUND}
    assert result.found.is_plausible


def test_who_insists_gets_measurements_and_a_warning():
    result = fitted("landscape", force=True)
    assert result.found.verdict is Verdict.NO_PERSON
    assert len(result.measurements) > 10
    (warning,) = [each for each in result.views[0].warnings if each.code == "no-person"]
    assert result.found.outcome_explanation in warning.reason


@pytest.mark.slow
@pytest.mark.parametrize("name", DONORS[:2])
def test_the_people_whose_points_these_are_get_theirs(name):
    request = changed(fit_request(read_case(CASES[name]), Cues.SE), force=False)
    result = fit(request)
    assert result.found.is_plausible
    assert len(result.measurements) > 10


BELLIES = SHARED_DATA / "cases" / "belly_front_and_side"


def front_and_side(name: str) -> FitResult:
    views = tuple(
        View(
            image=(BELLIES / f"{name}_{kind.value[0]}.jpg").read_bytes(),
            clicks={},
            kind=kind,
            complete_clicks=True,
        )
        for kind in (ViewKind.FRONT, ViewKind.SIDE)
    )
    return fit(FitRequest(person=Person(gender=Gender.FEMALE, height_m=1.68), views=views))


@pytest.mark.slow
@needs_shared(BELLIES)
def test_bellies_grow_by_the_tape_or_are_withheld():
    found = [front_and_side(name) for name in ("preg0", "preg6", "preg_round9")]
    navels = [
        next(each.value for each in result.measurements if each.name == "waist_girth_navel")
        for result in found
    ]
    assert navels == pytest.approx([80.6, 88.8, 93.9], abs=3.0)
    for name in ("preg12", "preg_round12", "preg_round15", "preg18"):
        result = front_and_side(name)
        assert result.measurements == ()
        codes = {each.code for view in result.views for each in view.found.findings}
        assert Code.CONTRADICTED in codes
        assert Code.COVERED not in codes
