"""Pictures and results on disk, named by their content.

Blobs live in scopes, one a job, so that erasing a job erases one folder: nothing is shared, so
nothing needs counting. A blob is written to a temporary file, flushed to the disk and renamed;
a reader sees all of it or nothing, and whatever was stored survives a crash.
"""

import hashlib
import os
import shutil
import tempfile
from pathlib import Path


class BlobStore:
    """Content-addressed files below a folder: ``root/scope[:2]/scope/sha256``."""

    def __init__(self, root: Path) -> None:
        self.root = root

    def put(self, scope: str, content: bytes) -> str:
        """Store ``content`` and return its SHA-256, its name in the scope."""
        digest = hashlib.sha256(content).hexdigest()
        folder = self._folder(scope)
        folder.mkdir(parents=True, exist_ok=True)
        handle, name = tempfile.mkstemp(dir=folder, prefix=".new-")
        temporary = Path(name)
        try:
            with os.fdopen(handle, "wb") as stream:
                stream.write(content)
                stream.flush()
                os.fsync(stream.fileno())
            temporary.rename(folder / digest)
        except BaseException:
            temporary.unlink(missing_ok=True)
            raise
        _sync_folder(folder)
        return digest

    def path(self, scope: str, digest: str) -> Path:
        """Where the blob lies; it may not exist."""
        return self._folder(scope) / digest

    def get(self, scope: str, digest: str) -> bytes:
        """Read a blob.

        Raises
        ------
        FileNotFoundError
            If it was erased or never stored.
        """
        return self.path(scope, digest).read_bytes()

    def erase(self, scope: str) -> None:
        """Remove everything in a scope; erasing nothing is fine."""
        shutil.rmtree(self._folder(scope), ignore_errors=True)

    def _folder(self, scope: str) -> Path:
        return self.root / scope[:2] / scope


def _sync_folder(folder: Path) -> None:
    # The rename itself must reach the disk, not only the file's content.
    handle = os.open(folder, os.O_RDONLY | os.O_DIRECTORY)
    try:
        os.fsync(handle)
    finally:
        os.close(handle)
