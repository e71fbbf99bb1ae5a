import io
import struct
import zlib

import pytest
from hypothesis import given
from hypothesis import strategies as st
from PIL import Image, ImageOps

from service.submissions import exif_header, image_header
from service.submissions.exif_header import MAX_ENTRIES, read_exif_facts
from service.submissions.image_header import DamagedImageError, UnknownImageError, read_image_header

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


def png_chunk(kind: bytes, content: bytes) -> bytes:
    check = struct.pack(">I", zlib.crc32(kind + content))
    return struct.pack(">I", len(content)) + kind + content + check


def turned(orientation: int) -> bytes:
    exif = Image.Exif()
    exif[0x0112] = orientation
    return exif.tobytes().removeprefix(b"Exif\0\0")


def with_exif_blocks(kind: str, *blocks: bytes) -> bytes:
    """A picture of 40 x 30 with several EXIF blocks, one after the other."""
    stream = io.BytesIO()
    Image.new("RGB", (40, 30)).save(stream, kind, **({"exif": turned(1)} if kind == "WEBP" else {}))
    content = stream.getvalue()
    if kind == "JPEG":
        marked = [b"Exif\0\0" + block for block in blocks]
        segments = [b"\xff\xe1" + struct.pack(">H", 2 + len(each)) + each for each in marked]
        return content[:2] + b"".join(segments) + content[2:]
    if kind == "PNG":
        start = content.index(b"IHDR") + 4 + 13 + 4
        chunks = b"".join(png_chunk(b"eXIf", block) for block in blocks)
        return content[:start] + chunks + content[start:]
    picture = content[12 : content.index(b"EXIF")]
    chunks = b"".join(b"EXIF" + struct.pack("<I", len(each)) + each for each in blocks)
    return b"RIFF" + struct.pack("<I", 4 + len(picture) + len(chunks)) + b"WEBP" + picture + chunks


@pytest.mark.parametrize("orientations", [(6, 1), (1, 6)])
@pytest.mark.parametrize("kind", KINDS)
def test_of_several_exif_blocks_the_one_is_read_that_a_decoder_takes(
    kind, orientations, monkeypatch
):
    read: list[bytes] = []
    monkeypatch.setattr(
        image_header, "read_exif_facts", lambda block: read.append(block) or read_exif_facts(block)
    )
    content = with_exif_blocks(kind, *map(turned, orientations))
    picture = Image.open(io.BytesIO(content))
    picture.load()
    header = read_image_header(content)
    assert (header.width, header.height) == ImageOps.exif_transpose(picture).size
    assert len(read) == 1


def test_a_directory_is_read_no_further_than_any_camera_writes(monkeypatch):
    unpacked: list[int] = []

    class Counting:
        error = struct.error

        @staticmethod
        def unpack_from(*arguments):
            unpacked.append(1)
            return struct.unpack_from(*arguments)

    monkeypatch.setattr(exif_header, "struct", Counting)
    entry = struct.pack("<HHIHH", 0x0112, 3, 1, 6, 0)
    # Its pointer to a second directory leads to the first.
    pointer = struct.pack("<HHII", 0x8769, 4, 1, 8)
    block = b"II*\0\x08\0\0\0" + struct.pack("<H", 65_535) + pointer + entry * 65_534
    assert read_exif_facts(block).orientation == 6
    assert len(unpacked) < 5 * MAX_ENTRIES


def test_a_png_with_two_header_chunks_is_damaged():
    content = encoded("PNG", (40, 30))
    second = png_chunk(b"IHDR", struct.pack(">IIBBBBB", 7000, 7000, 8, 2, 0, 0, 0))
    with pytest.raises(DamagedImageError):
        read_image_header(content[:33] + second + content[33:])
