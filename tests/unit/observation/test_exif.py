import io
import struct

import numpy as np
import pytest
from PIL import Image as PillowImage
from PIL.TiffImagePlugin import IFDRational

from fitter.observation.decoding import decode_picture
from fitter.observation.picture_files import ExifTags, read_exif
from tests.unit.observation.pictures import HEIGHT, WIDTH, encode, smooth

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
