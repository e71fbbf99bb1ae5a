"""Pictures and results as blobs: on the local disk, or in S3-compatible object storage.

Blobs live in scopes, one per fit, and are named by their content. Nothing is shared between scopes,
so erasing a fit erases one scope, without reference counting. The database holds only names of
blobs: what a caller sent (picture, mask, points, whom to notify and with what secret) and what was
made from it is here and nowhere else.
"""

from collections.abc import Iterable, Iterator
from typing import Protocol
from urllib.parse import urlsplit

from service.settings import PREFIX, SettingError, Settings


class BlobMissingError(Exception):
    """There is no such blob: it was erased, or never stored."""


class BlobsUnavailableError(Exception):
    """The store cannot be reached or does not answer; what was to be stored is not stored."""


class BlobDamagedError(BlobsUnavailableError):
    """What is stored is not what was; a copy may be put back."""

    def __init__(self, name: str) -> None:
        super().__init__(f"blob {name} has another content than its name says")


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
        """Return a blob whose content is what its name says.

        Raises
        ------
        BlobMissingError
            If it was erased or never stored.
        """
        ...

    def scopes(self) -> Iterator[str]:
        """Return the scopes that hold anything, in no order."""
        ...

    def erase(self, scope: str) -> None:
        """Remove everything in a scope; erasing nothing is fine."""
        ...

    def check_writable(self) -> None:
        """Store and remove a blob of a few bytes, or raise."""
        ...


def setting_of_storage(settings: Settings) -> str:
    """The setting that says where blobs are, as an operator would write it."""
    if settings.blob_url is None:
        return f"{PREFIX}DATA_DIR={settings.data_dir}"
    return f"{PREFIX}BLOB_URL={settings.blob_url}"


def open_blob_store(settings: Settings) -> BlobStore:
    """Open the store named by ``blob_url``: ``s3://bucket/prefix``, or the data folder if unset.

    Raises
    ------
    SettingError
        If S3 is asked for and its client is not installed.
    """
    # Only here: the stores import the errors above, and S3's client, an extra, takes a third of a
    # second to load.
    if settings.blob_url is None:
        from service.jobs.blobs_local import LocalBlobStore

        return LocalBlobStore(settings.blob_dir)
    url = urlsplit(settings.blob_url)
    try:
        from service.jobs.blobs_s3 import S3BlobStore
    except ImportError as error:
        message = "S3 needs the client; install it with: pip install 'maquette[s3]'"
        raise SettingError(message, name="blob_url", value=settings.blob_url) from error
    return S3BlobStore(bucket=url.netloc, prefix=url.path)
