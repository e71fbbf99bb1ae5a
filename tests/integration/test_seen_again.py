"""The sample, changed by what nobody sees, has the same body to well within the stated error.

It is saved again, cropped by two pixels, made one per cent smaller and one grey level brighter.
"""

import io
from dataclasses import replace

import cv2
import numpy as np
import pytest
from jaxtyping import UInt8
from PIL import Image as PillowImage

from fitter.fits.pipeline import fit
from fitter.request import FitRequest
from fitter.result import FitResult
from tests.accuracy.runs import picture_of
from tests.accuracy.table import MEASUREMENTS
from tests.one_picture import changed

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
