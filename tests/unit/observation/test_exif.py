"""EXIF, and the focal length that follows."""

import io
import struct
from typing import Any

import numpy as np
import pytest
from PIL import Image as PillowImage
from PIL.TiffImagePlugin import IFDRational

from fitter.errors import InvalidInputError
from fitter.observation.decoding import decode_picture
from fitter.observation.focal_length import FocalLength, focal_length
from fitter.observation.picture_files import ExifTags, read_exif
from fitter.vocabulary.outcomes import FocalLengthSource
from tests.unit.observation.pictures import HEIGHT, WIDTH, encode, smooth, view

UPRIGHT = smooth()

# How a camera that stores with each orientation must have turned the upright picture.
STORED_AS = {
    1: UPRIGHT,
    2: UPRIGHT[:, ::-1],
    3: UPRIGHT[::-1, ::-1],
    4: UPRIGHT[::-1],
    5: UPRIGHT.transpose(1, 0, 2),
    6: np.rot90(UPRIGHT),
    7: np.rot90(UPRIGHT[::-1, ::-1].transpose(1, 0, 2), 0),
    8: np.rot90(UPRIGHT, -1),
}


def with_exif(directory: dict[int, object], *, orientation: object = None) -> bytes:
    exif = PillowImage.Exif()
    if orientation is not None:
        exif[0x0112] = orientation
    exif.get_ifd(0x8769).update(directory)
    return encode(PillowImage.new("RGB", (WIDTH, HEIGHT)), "JPEG", exif=exif)


@pytest.mark.parametrize(
    ("written", "warned"),
    [
        ((10 * WIDTH, 10 * HEIGHT), False),
        ((10 * HEIGHT, 10 * WIDTH), False),
        ((10 * WIDTH + 3, 10 * HEIGHT), False),
        ((10 * WIDTH, round(10 * HEIGHT / 0.85)), True),
        ((10 * WIDTH, round(10 * HEIGHT / 1.15)), True),
    ],
)
def test_a_picture_of_another_ratio_than_the_camera_wrote_is_warned_of(written, warned):
    data = with_exif({0xA002: written[0], 0xA003: written[1]})
    picture = decode_picture(data, field="image", max_pixels=10**6)
    assert [each.code for each in picture.warnings] == ["other-shape"] * warned


def tags(data: bytes) -> ExifTags:
    return read_exif(PillowImage.open(io.BytesIO(data)))


@pytest.mark.parametrize("kind", ["PNG", "WEBP"])
@pytest.mark.parametrize("orientation", range(1, 9))
def test_every_exif_orientation_comes_out_upright(orientation: int, kind: str):
    exif = PillowImage.Exif()
    exif[0x0112] = orientation
    stored = PillowImage.fromarray(np.ascontiguousarray(STORED_AS[orientation]))
    options = {"lossless": True} if kind == "WEBP" else {}
    picture = decode_picture(
        encode(stored, kind, exif=exif, **options), field="image", max_pixels=1_000_000
    )
    np.testing.assert_array_equal(picture.pixels, UPRIGHT)
    assert picture.stored_width == stored.width


@pytest.mark.parametrize("orientation", [0, 9, 77])
def test_an_orientation_out_of_range_counts_as_upright(orientation: int):
    assert tags(with_exif({}, orientation=orientation)).orientation == 1


def test_focal_length_fields_are_read():
    found = tags(
        with_exif(
            {0xA405: 28, 0x920A: IFDRational(4200, 1000), 0xA20E: IFDRational(10160), 0xA002: 4000}
        )
    )
    assert found.focal_length_35mm == 28
    assert found.focal_length_mm == pytest.approx(4.2)
    assert found.sensor_pixels_per_mm == pytest.approx(400.0)
    assert found.pixel_x_dimension == 4000


@pytest.mark.parametrize(("unit", "millimetres"), [(2, 25.4), (3, 10), (4, 1), (5, 0.001)])
def test_sensor_resolution_is_in_its_unit(unit: int, millimetres: float):
    found = tags(with_exif({0xA20E: IFDRational(5080), 0xA210: unit}))
    assert found.sensor_pixels_per_mm == pytest.approx(5080 / millimetres)


def test_an_unknown_resolution_unit_gives_no_sensor_size():
    assert tags(with_exif({0xA20E: IFDRational(5080), 0xA210: 1})).sensor_pixels_per_mm is None


@pytest.mark.parametrize("value", [0, IFDRational(0, 0), IFDRational(-5, 1)])
def test_values_that_mean_unknown_are_none(value: object):
    found = tags(with_exif({0xA405: 0, 0x920A: value, 0xA20E: value}))
    assert found == ExifTags()


def test_a_picture_without_exif_has_none():
    assert tags(encode(PillowImage.new("RGB", (8, 8)), "JPEG")) == ExifTags()


def test_a_broken_exif_block_counts_as_none():
    data = encode(
        PillowImage.new("RGB", (WIDTH, HEIGHT)), "JPEG", exif=b"Exif\x00\x00II*\x00\xff\xff\xff\x7f"
    )
    picture = decode_picture(data, field="image", max_pixels=1_000_000)
    assert picture.exif == ExifTags()


def test_an_orientation_beside_a_damaged_directory_still_turns_the_picture():
    entries = struct.pack("<HHIHH", 0x0112, 3, 1, 6, 0) + struct.pack("<HHII", 0x8769, 4, 1, 38)
    # The EXIF directory claims nine entries and ends at once.
    block = b"II*\x00" + struct.pack("<IH", 8, 2) + entries + bytes(4) + struct.pack("<H", 9)
    stored = PillowImage.fromarray(np.ascontiguousarray(STORED_AS[6]))
    data = encode(stored, "JPEG", quality=95, exif=b"Exif\x00\x00" + block)
    picture = decode_picture(data, field="image", max_pixels=1_000_000)
    assert np.abs(picture.pixels.astype(int) - UPRIGHT).mean() < 3


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
