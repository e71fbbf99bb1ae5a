import numpy as np
import pytest

from fitter.body.storage import load_body_model, packaged_model_path
from fitter.training.report.limb_length_figures import LIMBS, LimbLengthFigures, limb_length_figures
from fitter.training.surveys.survey_moments import load_moments, packaged_moments_path

LARGEST_ERROR_MM = {
    "upper arm": 5.0,
    "forearm": 3.0,
    "hand": 3.0,
    "foot": 4.0,
    "crotch height": 14.0,
    "nape height": 7.0,
    "trunk": 11.0,
    "shoulders across": 6.0,
}
"""At any of fifty heights from the survey's 1st to its 99th percentile. Heavier people's crotch is
lower, and shoulder heights are what subjects are solved for most loosely."""

LARGEST_OFFSET_MM = {
    "upper arm": 4.0,
    "foot": 3.0,
    "knee height": 4.0,
    "crotch height": 7.0,
    "nape height": 6.0,
    "shoulders across": 5.0,
}
"""Mean over the heights, off people of the predicted weight too."""

SLOPE_TOLERANCE = 0.25


@pytest.fixture(scope="module", params=["female", "male"])
def figures(request) -> LimbLengthFigures:
    model = load_body_model(packaged_model_path(request.param))
    return limb_length_figures(model, load_moments(packaged_moments_path(), request.param))


def test_fifty_heights_span_the_surveys_percentiles(figures: LimbLengthFigures):
    assert len(figures.heights) == 50
    # Of 1,986 women and 4,082 men: 148.1 to 178.5 and 160.0 to 192.0 cm.
    assert np.ptp(figures.heights) == pytest.approx(31.0, abs=1.5)


@pytest.mark.parametrize("name", LARGEST_ERROR_MM)
def test_a_height_alone_predicts_limbs_as_the_survey_has_them(
    figures: LimbLengthFigures, name: str
):
    limb = [limb.name for limb in figures.limbs].index(name)
    assert np.abs(figures.errors_mm[:, limb]).max() < LARGEST_ERROR_MM[name]


def test_limbs_grow_with_stature(figures: LimbLengthFigures):
    ours, surveyed = figures.slopes
    assert (np.diff(figures.predicted, axis=0) > 0.0).all()
    quotient = dict(zip((limb.name for limb in LIMBS), ours / surveyed, strict=True))
    for name in LARGEST_ERROR_MM:
        assert quotient[name] == pytest.approx(1.0, abs=SLOPE_TOLERANCE), name


def test_errors_of_limbs_that_are_defined_otherwise_are_about_their_mean(
    figures: LimbLengthFigures,
):
    for limb, errors, offset in zip(
        figures.limbs, figures.errors_mm.T, figures.offsets_mm, strict=True
    ):
        mean = 0.0 if limb.difference else offset
        assert errors.mean() == pytest.approx(mean, abs=1e-9), limb.name


@pytest.mark.parametrize("name", LARGEST_OFFSET_MM)
def test_lengths_agree_among_people_as_tall_and_as_heavy(figures: LimbLengthFigures, name: str):
    limb = [limb.name for limb in figures.limbs].index(name)
    assert abs(figures.alike_offsets_mm[limb]) < LARGEST_OFFSET_MM[name]


def test_the_crotch_of_heavier_people_is_lower(figures: LimbLengthFigures):
    limb = [limb.name for limb in figures.limbs].index("crotch height")
    lower = (figures.surveyed - figures.surveyed_alike)[:, limb].mean()
    assert lower > 0.1
