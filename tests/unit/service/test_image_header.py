import io

import pytest
from hypothesis import given
from hypothesis import strategies as st
from PIL import Image, ImageOps

from service.exif_header import read_exif_facts
from service.image_header import DamagedImageError, UnknownImageError, read_image_header

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


@given(st.binary(max_size=300), st.sampled_from([b"II*\0\x08\0\0\0", b"MM\0*\0\0\0\x08"]))
def test_a_damaged_exif_block_counts_as_none(tail, magic):
    facts = read_exif_facts(magic + tail)
    assert 1 <= facts.orientation <= 8
    assert facts.focal_length_35mm is None or facts.focal_length_35mm > 0.0


@pytest.mark.parametrize("options", [{"lossless": True}, {"quality": 50}])
def test_webp_without_extended_header_is_read(options):
    stream = io.BytesIO()
    Image.new("RGB", (123, 45)).save(stream, "WEBP", **options)
    header = read_image_header(stream.getvalue())
    assert (header.width, header.height) == (123, 45)


@pytest.mark.parametrize(
    ("kind", "mode"), [("JPEG", "CMYK"), ("JPEG", "L"), ("PNG", "I;16"), ("PNG", "RGBA")]
)
def test_the_kind_of_pixels_does_not_matter_here(kind, mode):
    header = read_image_header(encoded(kind, (31, 17), mode=mode))
    assert (header.width, header.height) == (31, 17)


def test_progressive_jpeg_is_read():
    header = read_image_header(encoded("JPEG", (64, 48), progressive=True))
    assert (header.width, header.height) == (64, 48)


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
    st.sampled_from([b"\xff\xd8\xff", b"\x89PNG\r\n\x1a\n", b"RIFFxxxxWEBP"]),
)
def test_arbitrary_bytes_behind_a_magic_number_raise_nothing_unexpected(tail, magic):
    try:
        header = read_image_header(magic + tail)
    except DamagedImageError:
        return
    assert header.width > 0
    assert header.height > 0


def test_a_size_of_zero_is_damage():
    content = bytearray(encoded("PNG", (40, 30)))
    content[16:20] = bytes(4)
    with pytest.raises(DamagedImageError):
        read_image_header(bytes(content))
