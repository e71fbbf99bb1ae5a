"""What is read of a picture's header agrees with what a decoder makes of the picture."""

import io
import zlib

import pytest
from hypothesis import given
from hypothesis import strategies as st
from PIL import Image, ImageOps

from api_schemas.picture import LARGEST_ASPECT_RATIO, LEAST_SIDE_PX
from fitter.observation import decoding
from service.submissions import image_header
from service.submissions.image_header import (
    DamagedImageError,
    UndecodedHeicError,
    UnknownImageError,
    read_image_header,
)
from tests.heif_files import EIGHT_BITS, Item, coded, heif, phone_picture, size

KINDS = {"JPEG": "image/jpeg", "PNG": "image/png", "WEBP": "image/webp"}


def encoded(
    kind: str, size: tuple[int, int], *, orientation: int = 1, mode: str = "RGB", **options
) -> bytes:
    exif = Image.Exif()
    exif[0x0112] = orientation
    stream = io.BytesIO()
    Image.new(mode, size).save(stream, kind, exif=exif, **options)
    return stream.getvalue()


@pytest.mark.parametrize("kind", KINDS)
@given(width=st.integers(1, 300), height=st.integers(1, 300), orientation=st.integers(1, 8))
def test_size_and_orientation_agree_with_a_decoder(kind, width, height, orientation):
    content = encoded(kind, (width, height), orientation=orientation)
    upright = ImageOps.exif_transpose(Image.open(io.BytesIO(content)))
    header = read_image_header(content)
    assert (header.width, header.height) == upright.size
    assert header.media_type == KINDS[kind]
    assert not header.animated


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize(("named", "read"), [(28, 28.0), (0, None), (None, None)])
def test_the_focal_length_is_read_where_it_is_named(kind, named, read):
    exif = Image.Exif()
    exif[0x0112] = 6
    if named is not None:
        exif.get_ifd(0x8769)[0xA405] = named
    stream = io.BytesIO()
    Image.new("RGB", (40, 30)).save(stream, kind, exif=exif)
    header = read_image_header(stream.getvalue())
    assert header.focal_length_35mm == read
    assert (header.width, header.height) == (30, 40)


@pytest.mark.parametrize(
    ("kind", "mode"), [("JPEG", "CMYK"), ("JPEG", "L"), ("PNG", "I;16"), ("PNG", "RGBA")]
)
def test_the_kind_of_pixels_does_not_matter_here(kind, mode):
    header = read_image_header(encoded(kind, (31, 17), mode=mode))
    assert (header.width, header.height) == (31, 17)


@pytest.mark.parametrize("kind", ["PNG", "WEBP"])
def test_an_animation_is_told_apart(kind):
    frames = [Image.new("RGB", (20, 10), color) for color in ("red", "blue")]
    stream = io.BytesIO()
    frames[0].save(stream, kind, save_all=True, append_images=frames[1:])
    assert read_image_header(stream.getvalue()).animated


@pytest.mark.parametrize("content", [b"", b"hello", b"GIF89a", b"%PDF-1.7", b"RIFF....WAVE"])
def test_other_files_are_no_images(content):
    with pytest.raises(UnknownImageError):
        read_image_header(content)


@pytest.mark.parametrize("kind", KINDS)
def test_a_header_cut_off_at_any_byte_is_damaged_or_still_gives_the_true_size(kind):
    content = encoded(kind, (40, 30))
    for length in range(12, min(len(content), 400)):
        try:
            header = read_image_header(content[:length])
        except DamagedImageError:
            continue
        assert (header.width, header.height) == (40, 30)


@given(
    st.binary(max_size=200),
    st.sampled_from(
        [b"\xff\xd8\xff", b"\x89PNG\r\n\x1a\n", b"RIFFxxxxWEBP", b"\0\0\0\x14ftypheic"]
    ),
)
def test_arbitrary_bytes_behind_a_magic_number_raise_nothing_unexpected(tail, magic):
    try:
        header = read_image_header(magic + tail)
    except DamagedImageError:
        return
    assert header.width > 0
    assert header.height > 0


def test_the_size_of_a_large_picture_is_told_without_decoding():
    content = bytearray(encoded("PNG", (40, 30)))
    content[16:24] = (20_000).to_bytes(4) + (20_000).to_bytes(4)
    # The checksum of the chunk is of no concern to who looks at the size.
    content[29:33] = zlib.crc32(content[12:29]).to_bytes(4)
    header = read_image_header(bytes(content))
    assert (header.width, header.height) == (20_000, 20_000)


def test_a_phones_heic_stands_upright_and_has_its_focal_length():
    picture = coded(EIGHT_BITS)
    content = phone_picture(picture, orientation=6, quarters=3, focal_length_35mm=26)
    header = read_image_header(content)
    assert header.media_type == "image/heic"
    assert (header.width, header.height) == (picture.height, picture.width)
    assert header.focal_length_35mm == 26.0


def test_a_heic_without_a_picture_is_damaged():
    with pytest.raises(DamagedImageError):
        read_image_header(heif(Item(b"hvc1", b"", (size(0, 0),))))


def test_a_heic_that_nothing_decodes_is_told_apart(monkeypatch):
    monkeypatch.setattr(image_header, "decodes_heif", lambda: False)
    with pytest.raises(UndecodedHeicError):
        read_image_header(EIGHT_BITS)


def with_scans(count: int, *, hidden: bytes = b"") -> bytes:
    """A progressive JPEG whose last scan is there so often."""
    content = encoded("JPEG", (64, 48), progressive=True)
    last = content.rindex(b"\xff\xda")
    once = read_image_header(content).scans
    return content[:last] + hidden + content[last:-2] * (count - once + 1) + content[-2:]


def test_scans_are_those_that_a_decoder_goes_through():
    assert read_image_header(encoded("JPEG", (64, 48))).scans == 1
    assert read_image_header(encoded("JPEG", (64, 48), progressive=True)).scans in range(6, 12)
    many = with_scans(800)
    assert read_image_header(many).scans == 800
    assert Image.open(io.BytesIO(many)).convert("L").size == (64, 48)


def test_scans_are_neither_hidden_nor_found_where_there_are_none():
    comment = b"\xff\xda" * 200
    told = b"\xff\xfe" + (len(comment) + 2).to_bytes(2) + comment
    plain = encoded("JPEG", (64, 48))
    assert read_image_header(plain[:2] + told + plain[2:] + comment).scans == 1
    # Among coded pixels a decoder passes over a marker of no meaning and its length.
    assert read_image_header(with_scans(300, hidden=b"\xff\x02\xff\xff")).scans == 300


def test_clients_are_told_the_limits_that_the_decoder_has():
    assert LEAST_SIDE_PX == decoding.LEAST_SIDE_PX
    assert LARGEST_ASPECT_RATIO == decoding.LARGEST_ASPECT_RATIO
