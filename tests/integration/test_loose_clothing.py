"""Fits of one person of the evaluation suite in loose clothes, said to be tight and loose."""

import re

import cv2
import numpy as np
import pytest

from fitter.fits.pipeline import fit
from fitter.request import Clothing, Cues
from fitter.result import FitResult
from fitter.vocabulary.remarks import Code
from tests.accuracy.cases import CASES
from tests.accuracy.files import CaseFiles, read_case
from tests.accuracy.true_picture import fit_request
from tests.one_picture import changed

WAIST, SMALLEST = "waist_girth_navel", "waist_girth_smallest"

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def files() -> CaseFiles:
    return read_case(CASES["clothed_woman_young_thin"])


@pytest.fixture(scope="module")
def fits(files: CaseFiles) -> dict[Clothing, FitResult]:
    request = fit_request(files, Cues.SES)
    return {clothing: fit(changed(request, clothing=clothing)) for clothing in Clothing}


def waist(result: FitResult, name: str = WAIST) -> tuple[float, float]:
    (found,) = [each for each in result.measurements if each.name == name]
    assert found.standard_error is not None
    return found.value, found.standard_error


def warned(result: FitResult) -> set[str]:
    return {each.code for view in result.views for each in view.warnings}


def test_the_waist_within_loose_clothes_is_nearer_to_the_truth_and_less_certain(files, fits):
    truth = files.document["truth"][WAIST]
    said = (Clothing.TIGHT, Clothing.LOOSE)
    (tight, tight_error), (loose, loose_error) = (waist(fits[clothing]) for clothing in said)
    assert abs(loose - truth) < 0.7 * abs(tight - truth)
    assert loose_error > tight_error


def test_the_result_says_in_a_line_what_loose_clothes_cost(fits):
    found = {
        clothing: {each.code: each for each in result.views[0].findings}
        for clothing, result in fits.items()
    }
    assert Code.CLOTHES_LOOSE not in found[Clothing.TIGHT]
    for said in (Clothing.LOOSE, Clothing.AUTO):
        told, (_, error) = (
            found[said][Code.CLOTHES_LOOSE],
            waist(fits[said], SMALLEST),
        )
        assert f"the smallest waist to ± {1.96 * error:.0f} cm" in told.reason
        (weighed,) = re.findall(r"the weight: ± (\d+) cm", told.remedy)
        assert 0.2 < float(weighed) / (1.96 * error) < 0.9


def test_a_body_within_loose_clothes_is_no_poor_fit(fits):
    result = fits[Clothing.LOOSE]
    assert result.found.outcome.value == "converged"
    assert result.found.silhouette_overlap > 0.9
    assert not [
        warning for warning in result.views[0].warnings if warning.code == "low-silhouette-overlap"
    ]


def test_saying_loose_of_underwear_is_questioned_and_of_loose_clothes_is_not(fits):
    request = fit_request(read_case(CASES["man_old_heavy_turned"]), Cues.SE)
    doubted = fit(changed(request, clothing=Clothing.LOOSE))
    said = [
        [each.code for each in result.views[0].warnings] for result in (doubted, *fits.values())
    ]
    assert ["clothes-not-loose" in codes for codes in said] == [True, False, False, False]


def test_what_is_not_said_of_loose_clothes_is_seen(files, fits):
    truth = files.document["truth"][WAIST]
    (tight, _), (found, error) = (waist(fits[said]) for said in (Clothing.TIGHT, Clothing.AUTO))
    assert abs(found - truth) < 0.8 * abs(tight - truth)
    assert abs(found - truth) < 3.0 * error


def test_a_picture_without_colours_cannot_tell_clothes_and_says_so(files):
    truth = files.document["truth"][WAIST]
    picture = cv2.imdecode(np.frombuffer(files.image, np.uint8), cv2.IMREAD_GRAYSCALE)
    grey = cv2.imencode(".png", picture)[1].tobytes()
    found = fit(changed(fit_request(files, Cues.SE), image=grey))
    assert Code.SKIN_NOT_FOUND in {each.code for each in found.views[0].findings}
    value, error = waist(found)
    assert abs(value - truth) < 2.0 * error


def test_of_people_in_underwear_nothing_need_be_said():
    request = fit_request(read_case(CASES["woman_114_middle_aged_thin_standing"]), Cues.SES)
    tight, found = (
        fit(changed(request, clothing=said)) for said in (Clothing.TIGHT, Clothing.AUTO)
    )
    assert [each.value for each in found.measurements] == [
        each.value for each in tight.measurements
    ]
