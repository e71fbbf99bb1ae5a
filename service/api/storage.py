"""The storage of blobs, its troubles as problems."""

import contextlib
from collections.abc import Iterable, Iterator
from typing import Final

from service.api.problems import ProblemError, not_found, problem_error
from service.jobs.blobs import BlobMissingError, BlobStore, BlobsUnavailableError, StorageFullError
from service.jobs.records import EngineFullError, StoredBlob

RETRY_WHEN_FULL_S: Final = 60
"""Somebody has to make room first."""


def disk_full() -> ProblemError:
    """Say that nothing can be stored now."""
    return problem_error(
        slug="insufficient-storage",
        code="disk-full",
        detail="Too little of the disk is free; nothing was kept.",
        remedy="Erase what you need no more by DELETE, or try again after the time in Retry-After.",
        headers={"Retry-After": str(RETRY_WHEN_FULL_S)},
    )


@contextlib.contextmanager
def storing() -> Iterator[None]:
    """Say so too if the disk fills up while storing."""
    try:
        yield
    except (StorageFullError, EngineFullError) as error:
        raise disk_full() from error


def store(blobs: BlobStore, scope: str, content: bytes, media_type: str) -> StoredBlob:
    """Store a file."""
    return StoredBlob(digest=blobs.put(scope, content), media_type=media_type)


def stored_content(blobs: BlobStore, scope: str, blob: StoredBlob) -> bytes:
    """Read a file of a fit; 404 if it has been erased in the meantime."""
    try:
        return blobs.get(scope, blob.digest)
    except BlobMissingError as error:
        raise not_found(what="such fit any more") from error


def erase_at_once(blobs: BlobStore, scope: str) -> None:
    """Erase what was stored for something that was not accepted."""
    # If this fails too, the sweep will do it.
    with contextlib.suppress(BlobsUnavailableError):
        blobs.erase(scope)


def erase_blobs(blobs: BlobStore, scopes: Iterable[str]) -> None:
    """Erase scopes whose records are gone.

    Raises
    ------
    ProblemError
        If the storage is unavailable: the sweep erases them once it is back.
    """
    try:
        for scope in scopes:
            blobs.erase(scope)
    except BlobsUnavailableError as error:
        raise problem_error(
            slug="not-ready",
            code="storage-unavailable",
            detail="It is not found any more, but the storage is not available: its files are "
            "erased once that is back.",
            remedy="Nothing has to be sent again.",
        ) from error
