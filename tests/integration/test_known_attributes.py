"""The sample's fit, told what is known of the person: the whole pipeline on a picture."""

import pytest

from fitter.errors import InvalidInputError
from fitter.fits.pipeline import fit
from fitter.request import FitRequest, KnownMeasurement
from fitter.result import FitResult, FitStage
from fitter.vocabulary.choices import Cues
from service.compute.translate import fit_request
from service.demo_data.sample import load_sample
from service.jobs.inputs import SentPicture
from tests.one_picture import changed
from tests.submissions import checked

SAMPLE = load_sample()
MOST_PIXELS = 50_000_000


def sample_request(**known: float | tuple[float, float]) -> FitRequest:
    """The sample with some of the true measurements, of silhouette and edges for speed."""
    asked = checked(SAMPLE.request, SAMPLE.image)
    pictures = (SentPicture(image=SAMPLE.image, mask=None),)
    request = fit_request(asked, pictures, max_pixels=MOST_PIXELS)
    return changed(
        request,
        cues=Cues.SE,
        measurements={
            name: KnownMeasurement(value=value[0], standard_error=value[1])
            if isinstance(value, tuple)
            else KnownMeasurement(value=value)
            for name, value in known.items()
        },
    )


def values(found: FitResult | FitStage) -> dict[str, float]:
    return {each.name: each.value for each in found.measurements}


def test_a_fit_has_what_it_was_given_from_its_first_body_to_its_last():
    truth = SAMPLE.truth
    request = sample_request(
        weight=truth["weight"],
        hip_girth=truth["hip_girth"],
        waist_girth_navel=(truth["waist_girth_navel"], 0.5),
    )
    result = fit(request)
    assert result.given == ("stature", "weight", "hip_girth", "waist_girth_navel")
    for found in (*result.stages, result):
        assert values(found)["weight"] == pytest.approx(truth["weight"], abs=0.01)
        assert values(found)["hip_girth"] == pytest.approx(truth["hip_girth"], abs=0.01)
        assert values(found)["stature"] == pytest.approx(100.0 * result.found.height_m, abs=0.01)
    waist = values(result)["waist_girth_navel"]
    assert waist == pytest.approx(truth["waist_girth_navel"], abs=0.5)
    assert result.energies["attributes"] < 1.0
    assert result.found.silhouette_overlap > 0.9
    errors = {each.name: each.standard_error or 0.0 for each in result.measurements}
    assert {errors[name] for name in ("stature", "weight", "hip_girth")} == {0.0}
    assert 0.2 < errors["waist_girth_navel"] < 0.5


def test_without_a_height_the_most_probable_one_is_held_and_said():
    truth = SAMPLE.truth
    known = sample_request(inseam=truth["inseam"], weight=truth["weight"])
    request = changed(known, height_m=None)
    result = fit(request)
    (height,) = (each for each in result.assumptions if each.where == ("height_m",))
    assert f"{result.found.height_m:.2f} m" in height.reason
    assert "inseam" in height.reason
    assert values(result)["inseam"] == pytest.approx(truth["inseam"], abs=0.01)
    assert values(result)["weight"] == pytest.approx(truth["weight"], abs=0.01)
    stature = next(each for each in result.measurements if each.name == "stature")
    assert stature.value == pytest.approx(100.0 * result.found.height_m, abs=0.01)
    assert stature.standard_error is not None
    assert 1.0 < stature.standard_error < 7.0


def test_a_contradiction_is_told_before_anything_is_searched():
    with pytest.raises(InvalidInputError) as caught:
        fit(sample_request(weight=SAMPLE.truth["weight"], waist_girth_navel=135.0))
    assert caught.value.code == "contradictory-measurements"
    assert caught.value.field == "measurements.waist_girth_navel"
