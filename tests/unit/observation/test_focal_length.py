from typing import Any

import pytest

from fitter.errors import InvalidInputError
from fitter.observation.focal_length import FocalLength, focal_length
from fitter.observation.picture_files import ExifTags
from fitter.vocabulary.outcomes import FocalLengthSource
from tests.unit.observation.pictures import view


def resolve(exif: ExifTags, *, stored_width: int = 4000, **changes: Any) -> FocalLength:
    return focal_length(
        view(b"", **changes), exif, width=3000, height=4000, stored_width=stored_width
    )


FULL = ExifTags(
    focal_length_35mm=28,
    focal_length_mm=5.0,
    sensor_pixels_per_mm=600.0,
    pixel_x_dimension=4000,
)


def test_the_35mm_equivalent_refers_to_the_diagonal():
    found = resolve(ExifTags(focal_length_35mm=43.27))
    assert found.pixels == pytest.approx(5000)
    assert found.source is FocalLengthSource.EXIF_35MM
    assert found.assumptions == ()


def test_the_callers_pixels_come_first():
    found = resolve(FULL, focal_length_px=4321.0)
    assert (found.pixels, found.source) == (4321.0, FocalLengthSource.CALLER)


def test_the_callers_equivalent_comes_before_exif():
    found = resolve(FULL, focal_length_35mm=86.54)
    assert found.pixels == pytest.approx(10_000)
    assert found.source is FocalLengthSource.CALLER


def test_the_sensor_serves_where_no_equivalent_is_written():
    exif = ExifTags(focal_length_mm=5.0, sensor_pixels_per_mm=600.0, pixel_x_dimension=4000)
    found = resolve(exif)
    assert found.pixels == pytest.approx(3000)
    assert found.source is FocalLengthSource.EXIF_SENSOR


def test_a_picture_resized_since_scales_the_sensors_pixels():
    exif = ExifTags(focal_length_mm=5.0, sensor_pixels_per_mm=600.0, pixel_x_dimension=8000)
    assert resolve(exif).pixels == pytest.approx(1500)


def test_an_unknown_focal_length_is_assumed_and_said_so():
    found = resolve(ExifTags())
    assert found.pixels == pytest.approx(50 / 43.27 * 5000)
    assert found.source is FocalLengthSource.ASSUMED
    assert [each.code for each in found.assumptions] == ["lens-assumed"]


def test_implausible_exif_is_passed_over():
    exif = ExifTags(focal_length_35mm=1.0, focal_length_mm=5.0, sensor_pixels_per_mm=1e9)
    assert resolve(exif).source is FocalLengthSource.ASSUMED


@pytest.mark.parametrize("field", ["focal_length_px", "focal_length_35mm"])
@pytest.mark.parametrize("value", [0.0, -50.0, float("nan"), float("inf")])
def test_an_impossible_focal_length_of_the_caller_is_refused(field: str, value: float):
    with pytest.raises(InvalidInputError) as caught:
        resolve(FULL, **{field: value})
    assert (caught.value.code, caught.value.field) == ("focal-length-invalid", field)


def test_two_focal_lengths_are_refused():
    with pytest.raises(InvalidInputError) as caught:
        resolve(FULL, focal_length_px=4000.0, focal_length_35mm=50.0)
    assert caught.value.code == "focal-length-twice"
