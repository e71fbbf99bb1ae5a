"""The sample's fit: told what is known of the person, and changed by what nobody sees."""

import io
from dataclasses import replace

import cv2
import numpy as np
import pytest
from jaxtyping import UInt8
from PIL import Image as PillowImage

from fitter.errors import InvalidInputError
from fitter.fits.pipeline import fit
from fitter.request import FitRequest, KnownMeasurement
from fitter.result import FitResult, FitStage
from fitter.vocabulary.choices import Cues
from service.compute.translate import fit_request
from service.demo_data.sample import load_sample
from service.jobs.inputs import SentPicture
from tests.accuracy.runs import picture_of
from tests.accuracy.table import MEASUREMENTS
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


Picture = UInt8[np.ndarray, "h w 3"]

QUALITY = 86
CROPPED_PX = 2
SMALLER = 0.99


def variants(request: FitRequest) -> dict[str, FitRequest]:
    """Requests that nobody could tell from this one by eye."""
    picture, kept = _decoded(request.views[0].image)
    height, width = picture.shape[:2]
    inner = picture[CROPPED_PX:-CROPPED_PX, CROPPED_PX:-CROPPED_PX]
    size = round(SMALLER * width), round(SMALLER * height)
    smaller = cv2.resize(picture, size, interpolation=cv2.INTER_AREA)
    return {
        "saved again": changed(request, image=_jpeg(picture, kept)),
        "cropped": _moved(request, _png(inner, kept), scale=1.0, by=float(CROPPED_PX)),
        "smaller": _moved(request, _png(smaller, kept), scale=size[0] / width, by=0.0),
        "brighter": changed(request, image=_png(np.minimum(picture, 254) + 1, kept)),
    }


@pytest.fixture(scope="module")
def sample() -> FitRequest:
    return picture_of("demo").request


@pytest.fixture(scope="module")
def fitted(sample) -> FitResult:
    return fit(sample)


@pytest.mark.parametrize("variant", ["saved again", "cropped", "smaller", "brighter"])
def test_girths_and_weight_stay_within_two_fifths_of_the_error(sample, fitted, variant: str):
    found = {each.name: each.value for each in fit(variants(sample)[variant]).measurements}
    stated = {each.name: each for each in fitted.measurements}
    for name, key, _ in MEASUREMENTS:
        each = stated[key]
        assert each.standard_error is not None
        assert abs(found[key] - each.value) < 0.4 * each.standard_error, name


def _moved(request: FitRequest, image: bytes, *, scale: float, by: float) -> FitRequest:
    """With another picture, its points and focal length as they are there."""
    view = request.views[0]
    focal = view.focal_length_px
    return changed(
        request,
        image=image,
        clicks={
            name: replace(click, x=scale * (click.x - by), y=scale * (click.y - by))
            for name, click in view.clicks.items()
        },
        focal_length_px=None if focal is None else scale * focal,
    )


def _decoded(image: bytes) -> tuple[Picture, PillowImage.Exif]:
    with PillowImage.open(io.BytesIO(image)) as picture:
        return np.asarray(picture.convert("RGB")), picture.getexif()


def _jpeg(picture: Picture, exif: PillowImage.Exif) -> bytes:
    stream = io.BytesIO()
    PillowImage.fromarray(picture).save(stream, "JPEG", quality=QUALITY, exif=exif)
    return stream.getvalue()


def _png(picture: Picture, exif: PillowImage.Exif) -> bytes:
    stream = io.BytesIO()
    PillowImage.fromarray(picture).save(stream, "PNG", exif=exif, compress_level=1)
    return stream.getvalue()
