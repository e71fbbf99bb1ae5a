"""What is read of a HEIC without a decoder agrees with what a decoder makes of it."""

import io
import struct

import pi_heif
import pytest
from hypothesis import given
from hypothesis import strategies as st
from PIL import Image

from service.submissions.image_header import DamagedImageError, read_image_header
from tests.heif_files import (
    EIGHT_BITS,
    SAMPLE_LYING,
    TEN_BITS,
    Item,
    box,
    coded,
    cropped,
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
WIDTH, HEIGHT = PICTURE.width, PICTURE.height


def size_in(content: bytes) -> tuple[int, int]:
    header = read_image_header(content)
    assert header.media_type == "image/heic"
    assert not header.animated
    return header.width, header.height


@pytest.mark.parametrize(
    "content",
    [
        EIGHT_BITS,
        TEN_BITS,
        SAMPLE_LYING,
        heif(picture_item(PICTURE, turned(1))),
        heif(picture_item(PICTURE, turned(2), mirrored(0))),
        heif(picture_item(PICTURE, cropped(81, 101), turned(3))),
        heif(picture_item(PICTURE, turned(3), cropped(101, 81))),
        heif(grid_item(2, 1, 150, 100, (2, 3)), picture_item(PICTURE), picture_item(PICTURE)),
        heif(picture_item(PICTURE), picture_item(PICTURE, turned(1)), primary=2),
        phone_picture(PICTURE, orientation=6, quarters=3),
    ],
)
def test_the_size_is_what_a_decoder_says(content):
    assert size_in(content) == pi_heif.open_heif(io.BytesIO(content)).size


@pytest.mark.parametrize(("named", "read"), [(26, 26.0), (0, None), (None, None)])
def test_the_focal_length_is_read_where_it_is_named(named, read):
    content = phone_picture(PICTURE, orientation=6, quarters=3, focal_length_35mm=named)
    assert read_image_header(content).focal_length_35mm == read
    assert size_in(content) == (HEIGHT, WIDTH)


def test_exif_of_another_picture_does_not_count():
    exif = Image.Exif()
    exif.get_ifd(0x8769)[0xA405] = 26
    items = (picture_item(PICTURE), picture_item(PICTURE), exif_item(exif, of=2))
    assert read_image_header(heif(*items)).focal_length_35mm is None
    assert read_image_header(heif(*items, primary=2)).focal_length_35mm == 26.0


@given(st.integers(0, 2**32 - 1), st.integers(0, 2**32 - 1))
def test_whatever_size_is_said_is_read_without_decoding(width, height):
    content = heif(Item(b"hvc1", b"", (size(width, height),)))
    if width and height:
        assert size_in(content) == (width, height)
    else:
        with pytest.raises(DamagedImageError):
            read_image_header(content)


def test_a_head_cut_off_at_any_byte_is_damaged_or_still_gives_the_true_size():
    content = phone_picture(PICTURE, orientation=6, quarters=3, focal_length_35mm=26)
    for length in range(24, len(content), 3):
        try:
            header = read_image_header(content[:length])
        except DamagedImageError:
            continue
        assert (header.width, header.height) == (HEIGHT, WIDTH)


@given(st.data())
def test_bytes_changed_in_the_head_raise_nothing_unexpected(data):
    content = bytearray(phone_picture(PICTURE, orientation=6, quarters=3, focal_length_35mm=26))
    for place in data.draw(st.lists(st.integers(24, 500), min_size=1, max_size=6)):
        content[place] = data.draw(st.integers(0, 255))
    try:
        header = read_image_header(bytes(content))
    except DamagedImageError:
        return
    assert header.width > 0
    assert header.height > 0


@pytest.mark.parametrize(
    ("meta", "reason"),
    [
        (b"", "the box 'pitm' is missing"),
        (full(b"pitm", b"\0\1"), "the box 'iprp' is missing"),
        (struct.pack(">I4s", 4, b"free"), "a box is shorter than its head"),
        (full(b"pitm", b"\0\1") + box(b"iprp", box(b"ipco")), "its primary picture has no size"),
    ],
)
def test_what_is_missing_is_named(meta, reason):
    content = box(b"ftyp", b"heic", bytes(4)) + full(b"meta", meta)
    with pytest.raises(DamagedImageError, match=reason):
        read_image_header(content)


def test_a_crop_by_nothing_is_damage():
    nothing = box(b"clap", struct.pack(">4I", 1, 0, 1, 1), bytes(16))
    with pytest.raises(DamagedImageError, match="crop"):
        read_image_header(heif(picture_item(PICTURE, nothing)))


def test_an_exif_block_in_very_many_pieces_is_not_put_together():
    content = phone_picture(PICTURE, orientation=6, quarters=3, focal_length_35mm=26)
    iloc = content.index(b"iloc") + 8
    # The second of two entries says that it has 65535 pieces.
    second = iloc + 4 + 14
    changed = content[: second + 4] + b"\xff\xff" + content[second + 6 :]
    assert read_image_header(changed).focal_length_35mm is None
