"""Memory that is given back."""

import mmap
import re
from pathlib import Path
from typing import BinaryIO

import pytest

from service.process.heap import give_back_files

SMAPS = Path("/proc/self/smaps")

pytestmark = pytest.mark.skipif(not SMAPS.exists(), reason="the kernel keeps no such account")


def resident_kib(path: Path) -> int:
    """How much of a file is mapped by this process and there."""
    found = re.findall(rf"{re.escape(str(path))}\n(?:.*\n)*?Rss: +(\d+) kB", SMAPS.read_text())
    return sum(map(int, found))


def read_only(file: BinaryIO) -> mmap.mmap:
    return mmap.mmap(file.fileno(), 0, flags=mmap.MAP_PRIVATE, prot=mmap.PROT_READ)


def test_pages_that_were_only_read_go_and_come_back(tmp_path):
    path = tmp_path / "read"
    content = bytes(range(256)) * 1024
    path.write_bytes(content)
    with path.open("rb") as file, read_only(file) as mapped:
        assert mapped[:] == content
        assert resident_kib(path) == len(content) // 1024
        give_back_files()
        assert resident_kib(path) < len(content) // 1024
        assert mapped[:] == content


def test_pages_that_were_written_to_stay_as_they_are(tmp_path):
    path = tmp_path / "written"
    path.write_bytes(bytes(65536))
    with path.open("rb") as file, mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_COPY) as mapped:
        mapped[:5] = b"words"
        give_back_files()
        assert mapped[:5] == b"words"
