"""Pictures and results as blobs: on the local disk, or in S3-compatible object storage.

Blobs live in scopes, one per fit, and are named by their content. Nothing is shared between scopes,
so erasing a fit erases one scope, without reference counting. The database holds only names of
blobs: what a caller sent (picture, mask, points, whom to notify and with what secret) and what was
made from it is here and nowhere else.
"""

import math
import threading
import time
from collections.abc import Callable, Iterable, Iterator
from typing import Final, Protocol, TypeVar

from service.process.retrying import retry_with_pauses
from service.settings import PREFIX, Settings

T = TypeVar("T")

SILENT_AFTER_S: Final = 5.0
"""A store that has answered nothing for so long, though asked, is away."""

AWAY_S: Final = 10.0
"""Whoever asks first after that looks again for all."""


class BlobMissingError(Exception):
    """There is no such blob: it was erased, or never stored."""


class BlobsUnavailableError(Exception):
    """The store cannot be reached or does not answer; what was to be stored is not stored."""


class BlobDamagedError(BlobsUnavailableError):
    """The blob is no longer what was stored; a copy of it may be put back."""

    def __init__(self, name: str) -> None:
        super().__init__(f"blob {name} has another content than its name says")


class StorageFullError(BlobsUnavailableError):
    """There is no room left."""


class StorageRefusedError(BlobsUnavailableError):
    """The store does not do what it is asked for as it is set up, however long one waits."""


class StorageUnusableError(Exception):
    """The store cannot be used as it is set up; the message, one line, says what to do."""


retry_while_storage_is_away = retry_with_pauses(BlobsUnavailableError, "storage")
"""Retries an operation on blobs, all of which are safe to repeat, for up to two minutes."""


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


class WatchedBlobs:
    """A store as the API asks it: not while it is away, so that nobody waits in vain.

    It is away while a call waits and nothing was answered for ``SILENT_AFTER_S``, and for
    ``AWAY_S`` after such a call was given up, unless a look finds it back: a ``check_writable`` is
    always made.
    """

    def __init__(
        self, blobs: BlobStore, *, monotonic: Callable[[], float] = time.monotonic
    ) -> None:
        self._blobs = blobs
        self._monotonic = monotonic
        self._lock = threading.Lock()
        self._asked_at: dict[object, float] = {}
        self._answered_at = -math.inf
        self._found_away_at = -math.inf

    def check_answering(self) -> None:
        """Raise :class:`BlobsUnavailableError` while the store is away."""
        with self._lock:
            now = self._monotonic()
            longest = min(self._asked_at.values(), default=now)
            is_silent = now - max(longest, self._answered_at) > SILENT_AFTER_S
            if is_silent or now - self._found_away_at < AWAY_S:
                message = "it did not answer when it was last asked"
                raise BlobsUnavailableError(message)

    def put(self, scope: str, content: bytes) -> str:
        """Store ``content`` and return its SHA-256, its name in the scope."""
        return self._ask(lambda: self._blobs.put(scope, content))

    def get(self, scope: str, name: str) -> bytes:
        """Return a blob, or raise :class:`BlobMissingError`."""
        return self._ask(lambda: self._blobs.get(scope, name))

    def erase(self, scope: str) -> None:
        """Remove everything in a scope; erasing nothing is fine."""
        self._ask(lambda: self._blobs.erase(scope))

    def check_writable(self) -> None:
        """Look: store and remove a blob of a few bytes, or raise."""
        self._watch(self._blobs.check_writable)

    def _ask(self, operation: Callable[[], T]) -> T:
        self.check_answering()
        return self._watch(operation)

    def _watch(self, operation: Callable[[], T]) -> T:
        call = object()
        began = self._monotonic()
        with self._lock:
            self._asked_at[call] = began
        try:
            found = operation()
        except BlobsUnavailableError:
            # Who is refused at once need not be spared.
            if self._monotonic() - began > SILENT_AFTER_S:
                self._found_away_at = self._monotonic()
            raise
        finally:
            with self._lock:
                del self._asked_at[call]
        self._answered_at = self._monotonic()
        self._found_away_at = -math.inf
        return found


def setting_of_storage(settings: Settings) -> str:
    """The setting that says where blobs are, as an operator would write it."""
    if settings.blob_url is None:
        return f"{PREFIX}DATA_DIR={settings.data_dir}"
    return f"{PREFIX}BLOB_URL={settings.blob_url}"
