"""What the service requires of a blob store, and the errors a store may raise."""

from collections.abc import Iterable
from typing import Protocol


class BlobMissingError(Exception):
    """There is no such blob: it was erased, or never stored."""


class BlobsUnavailableError(Exception):
    """The store cannot be reached or does not answer; what was to be stored is not stored."""


class StorageFullError(BlobsUnavailableError):
    """There is no room left."""


class StorageRefusedError(BlobsUnavailableError):
    """The store does not do what it is asked for as it is set up, however long one waits."""


class StorageUnusableError(Exception):
    """The store cannot be used as it is set up; the message, one line, says what to do."""


class BlobStore(Protocol):
    """Content-addressed bytes in scopes.

    Every method may raise :class:`BlobsUnavailableError`. A reader sees all of a blob or nothing,
    and what ``put`` has returned for survives a crash of this process and of its machine.
    """

    def prepare(self) -> None:
        """Create the folder or bucket for the blobs unless it exists."""
        ...

    def put(self, scope: str, content: bytes) -> str:
        """Store ``content`` and return its SHA-256, its name in the scope."""
        ...

    def put_all(self, scope: str, contents: Iterable[bytes]) -> list[str]:
        """Store several at once, and return their names."""
        ...

    def get(self, scope: str, name: str) -> bytes:
        """Return a blob.

        Raises
        ------
        BlobMissingError
            If it was erased or never stored.
        """
        ...

    def erase(self, scope: str) -> None:
        """Remove everything in a scope; erasing nothing is fine."""
        ...

    def check_writable(self) -> None:
        """Store and remove a blob of a few bytes, or raise."""
        ...
