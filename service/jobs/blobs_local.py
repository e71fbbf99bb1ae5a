"""Blobs as files below a folder, for one machine or a file system that several share.

A blob is written to a file without a name, flushed to the disk and then named; a reader sees all of
it or nothing, whatever was stored survives a crash, and a writer that is killed leaves nothing.
"""

import contextlib
import errno
import hashlib
import os
import shutil
import tempfile
import uuid
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import BinaryIO, Final

from service.jobs.blobs import (
    BlobDamagedError,
    BlobMissingError,
    BlobsUnavailableError,
    StorageFullError,
)
from service.process.data_folder import make_private_folder

FULL: Final = frozenset({errno.ENOSPC, errno.EDQUOT, errno.EFBIG})

NAMELESS_UNKNOWN: Final = frozenset({errno.EOPNOTSUPP, errno.EISDIR, errno.EINVAL})
"""Errors of file systems without nameless files, such as NFS."""


class LocalBlobStore:
    """Content-addressed files: ``root/scope[:2]/scope/sha256``."""

    def __init__(self, root: Path) -> None:
        self.root = root

    def prepare(self) -> None:
        """Create the folder unless it exists."""
        with _told():
            make_private_folder(self.root)

    def put(self, scope: str, content: bytes) -> str:
        """Store ``content`` and return its SHA-256, its name in the scope.

        Raises
        ------
        BlobMissingError
            If the scope was erased meanwhile.
        """
        (digest,) = self.put_all(scope, [content])
        return digest

    def put_all(self, scope: str, contents: Iterable[bytes]) -> list[str]:
        """Store several at once, and return their names; one write of the folder names them all.

        Raises
        ------
        BlobMissingError
            If the scope was erased meanwhile.
        """
        folder = self._folder(scope)
        files = list(contents)
        digests = [hashlib.sha256(content).hexdigest() for content in files]
        try:
            with _told():
                for each in (self.root, folder.parent, folder):
                    make_private_folder(each)
                for digest, content in zip(digests, files, strict=True):
                    _write(folder / digest, content)
                _sync_folder(folder)
        except FileNotFoundError as error:
            raise BlobMissingError(scope) from error
        return digests

    def get(self, scope: str, name: str) -> bytes:
        """Read a blob.

        Raises
        ------
        BlobMissingError
            If it was erased or never stored.
        BlobDamagedError
            If what is there is not what was stored.
        """
        try:
            with _told():
                content = (self._folder(scope) / name).read_bytes()
        except FileNotFoundError as error:
            raise BlobMissingError(name) from error
        # Disks flip bits, and a hundredth of a second finds out.
        if hashlib.sha256(content).hexdigest() != name:
            raise BlobDamagedError(name)
        return content

    def scopes(self) -> Iterator[str]:
        """Return the scopes that hold anything, in no order."""
        with _told():
            yield from (folder.name for folder in self.root.glob("*/*"))

    def erase(self, scope: str) -> None:
        """Remove everything in a scope; erasing nothing is fine."""
        folder = self._folder(scope)
        with _told(), contextlib.suppress(FileNotFoundError):
            # Twice: a file may come in between the listing of the folder and its removal.
            for last in (False, True):
                try:
                    shutil.rmtree(folder)
                    break
                except OSError as error:
                    if last or error.errno != errno.ENOTEMPTY:
                        raise

    def check_writable(self) -> None:
        """Write and remove a file."""
        scope = f".probe-{uuid.uuid4().hex}"
        try:
            self.put(scope, b"probe")
        finally:
            self.erase(scope)

    def _folder(self, scope: str) -> Path:
        return self.root / scope[:2] / scope


@contextlib.contextmanager
def _told() -> Iterator[None]:
    """Turn errors of the disk into the store's own; a missing file is passed on as it is."""
    try:
        yield
    except FileNotFoundError:
        raise
    except OSError as error:
        kind = StorageFullError if error.errno in FULL else BlobsUnavailableError
        raise kind(error.strerror) from error


def _write(path: Path, content: bytes) -> None:
    try:
        handle = os.open(path.parent, os.O_TMPFILE | os.O_WRONLY, 0o600)
    except OSError as error:
        if error.errno not in NAMELESS_UNKNOWN:
            raise
        _write_named(path, content)
    else:
        with os.fdopen(handle, "wb") as stream:
            _flush(stream, content)
            # What is there already has the same content.
            with contextlib.suppress(FileExistsError):
                # Naming a folder, though the path needs none, makes this follow the link in /proc.
                os.link(f"/proc/self/fd/{handle}", path, src_dir_fd=handle)


def _write_named(path: Path, content: bytes) -> None:
    """For file systems that need a name: if the process dies here, the file stays in its scope."""
    handle, name = tempfile.mkstemp(dir=path.parent, prefix=".new-")
    temporary = Path(name)
    try:
        with os.fdopen(handle, "wb") as stream:
            _flush(stream, content)
        temporary.rename(path)
    except BaseException:
        temporary.unlink(missing_ok=True)
        raise


def _flush(stream: BinaryIO, content: bytes) -> None:
    stream.write(content)
    stream.flush()
    os.fsync(stream.fileno())


def _sync_folder(folder: Path) -> None:
    # The name itself must reach the disk, not only the file's content.
    handle = os.open(folder, os.O_RDONLY | os.O_DIRECTORY)
    try:
        os.fsync(handle)
    finally:
        os.close(handle)
