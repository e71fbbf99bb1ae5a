import contextlib
import io
import struct
import zlib

import cv2
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from PIL import Image as PillowImage
from PIL import ImageCms

from fitter.errors import InvalidInputError
from fitter.observation.decoding import DecodedPicture, decode_coverage, decode_picture
from fitter.observation.picture_files import WHOLE_PIXELS
from fitter.observation.pixels import display_from_linear
from fitter.request import Choices
from tests.unit.observation.pictures import HEIGHT, WIDTH, encode, noise, smooth

RGB = PillowImage.fromarray(noise())
SMOOTH = PillowImage.fromarray(smooth())


def decode(data: bytes) -> np.ndarray:
    return decode_picture(data, field="image", max_pixels=1_000_000).pixels


def code_of(data: bytes, *, max_pixels: int = 1_000_000) -> str:
    with pytest.raises(InvalidInputError) as caught:
        decode_picture(data, field="image", max_pixels=max_pixels)
    assert caught.value.field == "image"
    assert caught.value.remedy
    return caught.value.code


def png_chunk(kind: bytes, body: bytes) -> bytes:
    return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))


def test_lossless_pictures_come_back_exactly():
    np.testing.assert_array_equal(decode(encode(RGB)), noise())
    np.testing.assert_array_equal(decode(encode(RGB, "WEBP", lossless=True)), noise())


@pytest.mark.parametrize("kind", ["JPEG", "WEBP"])
def test_lossy_pictures_come_back_nearly(kind: str):
    decoded = decode(encode(SMOOTH, kind, quality=95)).astype(int)
    assert np.abs(decoded - smooth()).mean() < 3


def test_a_file_of_0_bytes_is_refused():
    assert code_of(b"") == "image-empty"


@pytest.mark.parametrize(
    "data",
    [b"hello", b"<svg/>", b"\x00" * 1000, encode(RGB, "GIF"), encode(RGB, "TIFF"),
     encode(RGB, "BMP"), encode(RGB, "ICO")],
)  # fmt: skip
def test_what_is_no_jpeg_png_or_webp_is_refused(data: bytes):
    assert code_of(data) == "image-unsupported"


@pytest.mark.parametrize("kind", ["JPEG", "PNG", "WEBP"])
@pytest.mark.parametrize("share", [0.02, 0.1, 0.5, 0.9])
def test_a_truncated_picture_is_refused(kind: str, share: float):
    data = encode(RGB, kind)
    assert code_of(data[: max(16, int(share * len(data)))]) == "image-damaged"


@settings(max_examples=60)
@given(
    kind=st.sampled_from(["JPEG", "PNG", "WEBP"]),
    places=st.lists(st.floats(0, 1, exclude_max=True), min_size=1, max_size=8),
    value=st.integers(0, 255),
)
def test_damaged_bytes_give_a_picture_or_a_clear_problem(
    kind: str, places: list[float], value: int
):
    data = bytearray(encode(SMOOTH, kind))
    for place in places:
        data[int(place * len(data))] = value
    with contextlib.suppress(InvalidInputError):
        assert decode(bytes(data)).dtype == np.uint8


def test_too_many_pixels_are_refused_before_decoding():
    assert code_of(encode(RGB), max_pixels=WIDTH * HEIGHT - 1) == "image-too-large"
    # 100 megapixels in the header and no pixel data at all: decoding would fail otherwise.
    header = struct.pack(">IIBBBBB", 10_000, 10_000, 8, 2, 0, 0, 0)
    bomb = b"\x89PNG\r\n\x1a\n" + png_chunk(b"IHDR", header) + png_chunk(b"IDAT", b"")
    assert code_of(bomb, max_pixels=50_000_000) == "image-too-large"


@pytest.mark.parametrize("kind", ["PNG", "WEBP"])
def test_an_animated_picture_is_refused(kind: str):
    data = encode(RGB, kind, save_all=True, append_images=[RGB.rotate(90)], duration=100)
    assert code_of(data) == "image-animated"


def test_the_first_view_of_a_multi_picture_jpeg_is_taken():
    data = encode(SMOOTH, "MPO", save_all=True, append_images=[RGB], quality=95)
    assert np.abs(decode(data).astype(int) - smooth()).mean() < 3


@pytest.mark.parametrize(
    ("size", "code"), [((63, 200), "image-too-small"), ((100, 2001), "image-too-narrow")]
)
def test_pictures_too_small_or_narrow_to_fit_in_are_refused(size: tuple[int, int], code: str):
    assert code_of(encode(PillowImage.new("RGB", size))) == code


def test_a_grey_picture_has_three_equal_channels():
    grey = noise(channels=1)
    np.testing.assert_array_equal(
        decode(encode(PillowImage.fromarray(grey))), np.repeat(grey[:, :, None], 3, axis=2)
    )


def test_a_16_bit_grey_picture_keeps_its_upper_8_bits():
    grey = noise(channels=1)
    data = encode(PillowImage.fromarray(grey.astype(np.uint16) * 257))
    np.testing.assert_array_equal(decode(data)[:, :, 1], grey)


def test_a_16_bit_colour_picture_keeps_its_upper_8_bits():
    encoded, data = cv2.imencode(".png", noise()[:, :, ::-1].astype(np.uint16) * 257)
    assert encoded
    np.testing.assert_array_equal(decode(data.tobytes()), noise())


def test_a_palette_picture_is_looked_up():
    indexed = SMOOTH.quantize(64)
    np.testing.assert_array_equal(decode(encode(indexed)), np.asarray(indexed.convert("RGB")))


def test_a_cmyk_picture_is_converted():
    decoded = decode(encode(SMOOTH.convert("CMYK"), "JPEG", quality=95))
    assert np.abs(decoded.astype(int) - smooth()).mean() < 6


def test_transparency_is_laid_over_white_with_a_warning():
    pixels = np.dstack([noise(), np.zeros((HEIGHT, WIDTH), dtype=np.uint8)])
    pixels[: HEIGHT // 2, :, 3] = 255
    picture = decode_picture(
        encode(PillowImage.fromarray(pixels)), field="image", max_pixels=1_000_000
    )
    np.testing.assert_array_equal(picture.pixels[: HEIGHT // 2], noise()[: HEIGHT // 2])
    np.testing.assert_array_equal(picture.pixels[HEIGHT // 2 :], 255)
    assert [warning.code for warning in picture.warnings] == ["transparency-over-white"]


def test_an_opaque_alpha_channel_changes_nothing_and_warns_of_nothing():
    picture = decode_picture(encode(RGB.convert("RGBA")), field="image", max_pixels=1_000_000)
    np.testing.assert_array_equal(picture.pixels, noise())
    assert picture.warnings == ()


def linear_srgb_profile() -> bytes:
    """A minimal ICC v2 profile: the primaries of sRGB with values proportional to light."""

    def xyz(x: float, y: float, z: float) -> bytes:
        return b"XYZ " + bytes(4) + struct.pack(">3i", *(round(v * 65536) for v in (x, y, z)))

    name = b"linear\x00"
    tags = {
        b"desc": b"desc" + bytes(4) + struct.pack(">I", len(name)) + name + bytes(78),
        b"wtpt": xyz(0.9642, 1.0, 0.8249),
        b"rXYZ": xyz(0.4361, 0.2225, 0.0139),
        b"gXYZ": xyz(0.3851, 0.7169, 0.0971),
        b"bXYZ": xyz(0.1431, 0.0606, 0.7141),
        b"rTRC": b"curv" + bytes(8),
        b"gTRC": b"curv" + bytes(8),
        b"bTRC": b"curv" + bytes(8),
    }
    table, body = struct.pack(">I", len(tags)), b""
    start = 128 + 4 + 12 * len(tags)
    for signature, content in tags.items():
        table += signature + struct.pack(">II", start + len(body), len(content))
        body += content + bytes(-len(content) % 4)
    header = struct.pack(
        ">I4sI4s4s4s", start + len(body), b"", 0x02100000, b"mntr", b"RGB ", b"XYZ "
    )
    header += bytes(12) + b"acsp" + bytes(28) + xyz(0.9642, 1.0, 0.8249)[8:]
    return header + bytes(128 - len(header)) + table + body


def test_a_colour_profile_is_honoured():
    grey = PillowImage.new("RGB", (WIDTH, HEIGHT), (128, 128, 128))
    expected = 255 * display_from_linear(np.array(128 / 255))
    decoded = decode(encode(grey, icc_profile=linear_srgb_profile()))
    np.testing.assert_allclose(decoded, expected, atol=2)


def test_an_srgb_profile_changes_nothing():
    profile = ImageCms.ImageCmsProfile(ImageCms.createProfile("sRGB")).tobytes()
    np.testing.assert_array_equal(decode(encode(RGB, icc_profile=profile)), noise())


def test_a_broken_colour_profile_is_ignored():
    np.testing.assert_array_equal(decode(encode(RGB, icc_profile=b"no profile")), noise())


def test_transparent_parts_of_a_mask_are_background():
    pixels = np.full((HEIGHT, WIDTH, 4), 255, dtype=np.uint8)
    pixels[:, : WIDTH // 2, 3] = 0
    coverage = decode_coverage(
        encode(PillowImage.fromarray(pixels)), field="mask", max_pixels=1_000_000
    )
    np.testing.assert_array_equal(coverage[:, : WIDTH // 2], 0)
    np.testing.assert_array_equal(coverage[:, WIDTH // 2 :], 255)


def test_a_mask_that_is_no_picture_is_named_as_the_mask():
    with pytest.raises(InvalidInputError) as caught:
        decode_coverage(b"no", field="mask", max_pixels=1_000_000)
    assert (caught.value.field, caught.value.code) == ("mask", "mask-unsupported")


def test_decoding_leaves_pillows_own_limit_alone():
    before = PillowImage.MAX_IMAGE_PIXELS
    decode(encode(RGB))
    assert before == PillowImage.MAX_IMAGE_PIXELS
    PillowImage.open(io.BytesIO(encode(RGB))).verify()


LARGE = PillowImage.fromarray(smooth()).resize((1001, 1335), PillowImage.Resampling.BICUBIC)


def reduced(data: bytes, share: float) -> DecodedPicture:
    """Decoded so that a share of the pixels of the large picture is kept."""
    enough = share * LARGE.width * LARGE.height
    return decode_picture(data, field="image", max_pixels=10**7, enough_pixels=enough)


@pytest.mark.parametrize(
    ("share", "reduction"),
    [(1.1, 1), (1.0, 1), (0.26, 1), (0.25, 2), (0.07, 2), (0.0625, 4), (0.015, 8), (0.0, 8)],
)
def test_a_jpeg_is_decoded_no_larger_than_needed(share: float, reduction: int):
    picture = reduced(encode(LARGE, "JPEG"), share)
    assert picture.reduction == reduction
    assert picture.pixels.shape == (-(-1335 // reduction), -(-1001 // reduction), 3)


@pytest.mark.parametrize("mode", ["RGB", "L", "CMYK"])
def test_a_reduced_jpeg_shows_the_means_of_its_pixels(mode: str):
    data = encode(LARGE.convert(mode), "JPEG", quality=95)
    whole = decode_picture(data, field="image", max_pixels=10**7).pixels
    picture = reduced(data, 0.2)
    assert picture.reduction == 2
    blocks = whole[:1334, :1000].reshape(667, 2, 500, 2, 3).mean(axis=(1, 3))
    np.testing.assert_allclose(picture.pixels[:667, :500], blocks, atol=3.0)


def test_a_reduced_jpeg_is_upright_and_knows_its_width():
    exif = PillowImage.Exif()
    exif[0x0112] = 6
    picture = reduced(encode(LARGE, "JPEG", exif=exif), 0.2)
    assert picture.pixels.shape == (501, 668, 3)
    assert picture.stored_width == LARGE.width


@pytest.fixture
def _few_whole_pixels(monkeypatch: pytest.MonkeyPatch) -> None:
    """The large picture has more pixels than are decoded, as those of phones do."""
    monkeypatch.setattr("fitter.observation.decoding.WHOLE_PIXELS", 400_000)


@pytest.mark.usefixtures("_few_whole_pixels")
def test_a_jpeg_of_more_pixels_than_are_decoded_is_reduced_and_knows_its_size():
    exif = PillowImage.Exif()
    exif[0x0112] = 6
    for enough, reduction in ((None, 2), (1e9, 2), (50_000.0, 4)):
        picture = decode_picture(
            encode(LARGE, "JPEG", exif=exif), field="image", max_pixels=10**7, enough_pixels=enough
        )
        assert picture.reduction == reduction
        assert (picture.width, picture.height) == (LARGE.height, LARGE.width)
        assert picture.pixels.shape[1] == -(-LARGE.height // reduction)


@pytest.mark.usefixtures("_few_whole_pixels")
@pytest.mark.parametrize("kind", ["PNG", "WEBP"])
def test_other_kinds_of_more_pixels_than_are_decoded_are_refused(kind: str):
    assert code_of(encode(LARGE, kind), max_pixels=10**7) == "image-too-large"


@pytest.mark.usefixtures("_few_whole_pixels")
def test_a_mask_of_more_pixels_than_are_decoded_is_refused():
    with pytest.raises(InvalidInputError) as caught:
        decode_coverage(encode(LARGE.convert("L"), "JPEG"), field="mask", max_pixels=10**7)
    assert caught.value.code == "mask-too-large"


def test_pictures_of_phones_pass():
    assert Choices().max_pixels >= 12_240 * 16_320
    assert WHOLE_PIXELS >= 8_192 * 6_144


def test_a_jpeg_that_breaks_off_is_refused_at_any_size():
    data = encode(LARGE, "JPEG")
    with pytest.raises(InvalidInputError) as caught:
        reduced(data[: len(data) // 2], 0.0)
    assert caught.value.code == "image-damaged"
