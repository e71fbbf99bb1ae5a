"""A disk of a few megabytes that can really be filled."""

import contextlib
import os
import shutil
import subprocess
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

BYTES_PER_MB = 1_000_000


@dataclass
class SmallDisk:
    """A file system of its own, and a file of somebody else's on it."""

    folder: Path

    @property
    def free_bytes(self) -> int:
        return shutil.disk_usage(self.folder).free

    def leave(self, free_bytes: int) -> None:
        """Fill up until no more than this is free."""
        with self._filler.open("ab", buffering=0) as stream, contextlib.suppress(OSError):
            while self.free_bytes > free_bytes:
                stream.write(os.urandom(min(1_000_000, self.free_bytes - free_bytes)))

    def clear(self) -> None:
        """Make room again."""
        self._filler.unlink(missing_ok=True)

    @property
    def _filler(self) -> Path:
        return self.folder / "filler"


@contextlib.contextmanager
def small_disk(folder: Path, *, megabytes: int) -> Iterator[SmallDisk]:
    """Mount a disk in memory; it is gone at the end, whoever still uses it.

    Raises
    ------
    PermissionError
        If this process may mount none.
    """
    folder.mkdir(exist_ok=True)
    options = f"size={megabytes * BYTES_PER_MB}"
    mounting = ["mount", "-t", "tmpfs", "-o", options, "maquette-test", str(folder)]
    done = subprocess.run(mounting, capture_output=True, text=True, check=False)
    if done.returncode:
        raise PermissionError(done.stderr)
    try:
        yield SmallDisk(folder)
    finally:
        subprocess.run(["umount", "--lazy", str(folder)], check=True)
