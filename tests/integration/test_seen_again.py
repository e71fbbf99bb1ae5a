"""The sample, changed by what nobody sees, has the same body to well within the stated error."""

import pytest

from fitter.fits.pipeline import fit
from fitter.result import FitResult
from tests.evaluation.again import COMPARED, variants
from tests.evaluation.runs import picture_of

SAVED_AT_86, CROPPED_BY_2_PX, SMALLER, BRIGHTER = 3, 5, 7, 8


@pytest.fixture(scope="module")
def sample():
    return picture_of("demo").request


@pytest.fixture(scope="module")
def fitted(sample) -> FitResult:
    return fit(sample)


@pytest.mark.parametrize("number", [SAVED_AT_86, CROPPED_BY_2_PX, SMALLER, BRIGHTER])
def test_girths_and_weight_stay_within_two_fifths_of_the_error(sample, fitted, number: int):
    found = {each.name: each.value for each in fit(variants(sample)[number]).measurements}
    stated = {each.name: each for each in fitted.measurements}
    for name, key, _ in COMPARED:
        each = stated[key]
        assert each.standard_error is not None
        assert abs(found[key] - each.value) < 0.4 * each.standard_error, name
