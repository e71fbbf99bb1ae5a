"""HEIC files as phones write them, decoded."""

import contextlib
import sys

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from PIL import Image as PillowImage

from fitter.errors import InvalidInputError
from fitter.observation.decoding import DecodedPicture, decode_coverage, decode_picture
from tests.heif_data.encode import HEIGHT, QUADRANTS, WIDTH
from tests.heif_files import (
    ALPHA,
    EIGHT_BITS,
    TEN_BITS,
    Item,
    coded,
    exif_item,
    full,
    grid_item,
    heif,
    mirrored,
    phone_picture,
    picture_item,
    size,
    turned,
)

PICTURE = coded(EIGHT_BITS)
PLAIN = heif(picture_item(PICTURE))


def decode(data: bytes, *, max_pixels: int = 1_000_000) -> DecodedPicture:
    return decode_picture(data, field="image", max_pixels=max_pixels)


def code_of(data: bytes, *, max_pixels: int = 1_000_000) -> str:
    with pytest.raises(InvalidInputError) as caught:
        decode(data, max_pixels=max_pixels)
    assert caught.value.field == "image"
    assert caught.value.remedy
    return caught.value.code


def corners(picture: DecodedPicture) -> np.ndarray:
    """The colours near the four corners."""
    height, width, _ = picture.pixels.shape
    return picture.pixels[np.ix_((8, height - 8), (8, width - 8))].astype(int)


@pytest.mark.parametrize("file", [EIGHT_BITS, TEN_BITS, PLAIN], ids=["8 bits", "10 bits", "own"])
def test_pictures_of_8_and_10_bits_are_decoded_to_8(file):
    picture = decode(file)
    assert picture.pixels.dtype == np.uint8
    assert picture.pixels.shape == (HEIGHT, WIDTH, 3)
    np.testing.assert_allclose(corners(picture), QUADRANTS, atol=3)
    assert picture.warnings == ()


@pytest.mark.parametrize(
    ("properties", "seen"),
    [
        ([turned(1)], np.rot90(QUADRANTS, 1)),
        ([turned(2)], np.rot90(QUADRANTS, 2)),
        ([turned(3)], np.rot90(QUADRANTS, 3)),
        ([mirrored(0)], QUADRANTS[::-1]),
        ([mirrored(1)], QUADRANTS[:, ::-1]),
        ([turned(1), mirrored(1)], np.rot90(QUADRANTS, 1)[:, ::-1]),
        ([mirrored(1), turned(1)], np.rot90(QUADRANTS[:, ::-1], 1)),
    ],
)
def test_a_picture_is_turned_and_mirrored_as_its_container_says(properties, seen):
    picture = decode(heif(picture_item(PICTURE, *properties)))
    np.testing.assert_allclose(corners(picture), seen, atol=3)


def test_a_turn_that_exif_repeats_is_made_once():
    picture = decode(phone_picture(PICTURE, orientation=6, quarters=3, focal_length_35mm=26))
    np.testing.assert_allclose(corners(picture), np.rot90(QUADRANTS, 3), atol=3)
    assert picture.exif.orientation == 1
    assert picture.exif.focal_length_35mm == 26.0
    assert picture.stored_width == WIDTH


def test_a_turn_that_only_exif_names_is_not_made():
    exif = PillowImage.Exif()
    exif[0x0112] = 3
    picture = decode(heif(picture_item(PICTURE), exif_item(exif)))
    np.testing.assert_allclose(corners(picture), QUADRANTS, atol=3)


def test_tiles_are_put_together():
    tiles = (picture_item(PICTURE), picture_item(PICTURE))
    picture = decode(heif(grid_item(2, 1, 2 * WIDTH, HEIGHT, (2, 3)), *tiles))
    assert picture.pixels.shape == (HEIGHT, 2 * WIDTH, 3)
    left = picture.pixels[:, :WIDTH].astype(int)
    np.testing.assert_array_equal(left, picture.pixels[:, WIDTH:])
    np.testing.assert_allclose(left[8, 8], QUADRANTS[0, 0], atol=3)


@pytest.mark.parametrize("primary", [1, 2])
def test_of_several_pictures_the_primary_one_is_taken(primary):
    items = (picture_item(PICTURE), picture_item(PICTURE, turned(2)))
    picture = decode(heif(*items, primary=primary))
    seen = QUADRANTS if primary == 1 else QUADRANTS[::-1, ::-1]
    np.testing.assert_allclose(corners(picture), seen, atol=3)


def auxiliary(kind: bytes) -> bytes:
    """A file whose second picture belongs to the first."""
    second = picture_item(PICTURE, full(b"auxC", kind), refers=((b"auxl", (1,)),))
    return heif(picture_item(PICTURE), second)


def test_transparency_is_laid_over_white_with_a_warning():
    picture = decode(auxiliary(ALPHA))
    assert [each.code for each in picture.warnings] == ["transparency-over-white"]
    assert (corners(picture)[0, 0] > QUADRANTS[0, 0] + 20).any()


def test_a_mask_may_be_a_heic():
    coverage = decode_coverage(PLAIN, field="mask", max_pixels=1_000_000)
    assert coverage[-8, -8] > 220
    assert coverage[-8, 8] < 80


def test_too_many_pixels_are_refused_before_decoding():
    assert code_of(PLAIN, max_pixels=WIDTH * HEIGHT - 1) == "image-too-large"
    # 7000 x 7000 pixels are said to be in the few bytes of a small picture.
    said = Item(b"hvc1", PICTURE.content, (PICTURE.parameters, size(7_000, 7_000)))
    assert code_of(heif(said)) == "image-too-large"


def test_a_picture_of_another_size_than_its_head_says_is_damaged():
    for width, height in ((64, 64), (640, 640)):
        said = Item(b"hvc1", PICTURE.content, (PICTURE.parameters, size(width, height)))
        assert code_of(heif(said)) == "image-damaged"


@pytest.mark.parametrize("share", [0.1, 0.5, 0.9, 0.99])
def test_a_truncated_picture_is_damaged(share):
    assert code_of(PLAIN[: int(share * len(PLAIN))]) == "image-damaged"


@settings(max_examples=100)
@given(
    places=st.lists(st.floats(0, 1, exclude_max=True), min_size=1, max_size=8),
    value=st.integers(0, 255),
)
def test_damaged_bytes_give_a_picture_or_a_clear_problem(places, value):
    data = bytearray(phone_picture(PICTURE, orientation=6, quarters=3))
    for place in places:
        data[int(place * len(data))] = value
    with contextlib.suppress(InvalidInputError):
        assert decode(bytes(data)).pixels.dtype == np.uint8


@pytest.mark.parametrize("brand", [b"avif", b"mp42", b"msf1"])
def test_other_files_of_boxes_are_refused(brand):
    assert code_of(heif(picture_item(PICTURE), brand=brand)) == "image-unsupported"


def test_without_the_decoder_the_error_names_it(monkeypatch):
    monkeypatch.setitem(sys.modules, "pi_heif", None)
    with pytest.raises(InvalidInputError) as caught:
        decode(PLAIN)
    assert caught.value.code == "heic-not-installed"
    assert "pi-heif" in caught.value.reason
    assert "maquette[heic]" in caught.value.remedy
