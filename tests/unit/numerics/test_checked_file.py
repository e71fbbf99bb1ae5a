"""Files with a checksum: whatever is changed of one is found."""

from collections.abc import Callable
from pathlib import Path

import pytest

from fitter.numerics.checked_file import ALIGNED, DamagedFileError, check, write_checked

PARTS = (b"first", bytes(100), b"last")


@pytest.fixture
def written(tmp_path: Path) -> Path:
    path = tmp_path / "folder" / "file"
    write_checked(path, PARTS)
    return path


def test_parts_are_read_as_written_each_from_an_aligned_place_on(written: Path):
    with written.open("rb") as file:
        check(file)
        assert file.tell() == ALIGNED
        content = file.read()
    assert [content[at : at + 5] for at in (0, 64, 192)] == [b"first", bytes(5), b"last\0"]
    assert list(written.parent.iterdir()) == [written]


def truncated(content: bytes) -> bytes:
    return content[: len(content) // 2]


def emptied(_: bytes) -> bytes:
    return b""


def zeroed(content: bytes) -> bytes:
    return bytes(len(content))


def flipped(content: bytes) -> bytes:
    middle = len(content) // 2
    return content[:middle] + bytes([content[middle] ^ 4]) + content[middle + 1 :]


def beheaded(content: bytes) -> bytes:
    return content[ALIGNED:]


@pytest.mark.parametrize("damage", [truncated, emptied, zeroed, flipped, beheaded])
def test_damage_is_found(written: Path, damage: Callable[[bytes], bytes]):
    written.write_bytes(damage(written.read_bytes()))
    with written.open("rb") as file, pytest.raises(DamagedFileError):
        check(file)
