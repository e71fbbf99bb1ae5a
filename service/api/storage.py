"""The storage of blobs, its troubles as problems."""

import contextlib
from collections.abc import Callable, Iterable, Iterator
from functools import partial
from typing import Final, ParamSpec, TypeVar

from anyio import CapacityLimiter, fail_after, to_thread

from service.api.problems import ProblemError, not_found, problem_error
from service.jobs.blobs import (
    BlobMissingError,
    BlobsUnavailableError,
    StorageFullError,
    WatchedBlobs,
)
from service.jobs.records import EngineFullError, EngineUnavailableError, StoredBlob

P = ParamSpec("P")
T = TypeVar("T")

_BLOBS: Final = CapacityLimiter(10)
_WRITES: Final = CapacityLimiter(6)
_THREADS: Final = CapacityLimiter(16)
"""Fewer than the connections to the database: reads find one while all these wait."""

TURN_WITHIN_S: Final = 20.0
"""Longest wait for a turn, seconds: twice a statement's limit. Then the caller is told to retry."""

RETRY_WHEN_FULL_S: Final = 60
"""Somebody has to make room first."""


async def with_blobs(
    blobs: WatchedBlobs, function: Callable[P, T], *args: P.args, **kwargs: P.kwargs
) -> T:
    """Call what reads or writes blobs, in threads of its own.

    A storage that does not answer keeps nothing else waiting, and is not asked while it is away.
    """
    blobs.check_answering()
    busy = BlobsUnavailableError("others wait for it")
    return await _in_turn(_BLOBS, busy, partial(function, *args, **kwargs))


async def writing(function: Callable[P, T], *args: P.args, **kwargs: P.kwargs) -> T:
    """Call what writes to the database alone, in threads of its own.

    A database that takes no writes still answers questions.
    """
    return await _in_turn(_WRITES, EngineUnavailableError(), partial(function, *args, **kwargs))


async def _in_turn(limiter: CapacityLimiter, busy: Exception, function: Callable[[], T]) -> T:
    borrower = object()
    try:
        with fail_after(TURN_WITHIN_S):
            await limiter.acquire_on_behalf_of(borrower)
    except TimeoutError:
        raise busy from None
    try:
        return await to_thread.run_sync(function, limiter=_THREADS)
    finally:
        limiter.release_on_behalf_of(borrower)


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


def store(blobs: WatchedBlobs, scope: str, content: bytes, media_type: str) -> StoredBlob:
    """Store a file."""
    return StoredBlob(digest=blobs.put(scope, content), media_type=media_type)


async def stored_content(blobs: WatchedBlobs, scope: str, blob: StoredBlob) -> bytes:
    """Read a file; 404 if it has been erased in the meantime."""
    try:
        return await with_blobs(blobs, blobs.get, scope, blob.digest)
    except BlobMissingError as error:
        raise not_found(what="such file any more") from error


def erase_at_once(blobs: WatchedBlobs, scope: str) -> None:
    """Erase what was stored for something that was not accepted."""
    # If this fails too, the sweep will do it.
    with contextlib.suppress(BlobsUnavailableError):
        blobs.erase(scope)


async def erase_blobs(blobs: WatchedBlobs, scopes: Iterable[str]) -> None:
    """Erase scopes whose records are gone.

    Raises
    ------
    ProblemError
        If the storage is unavailable: the sweep erases them once it is back.
    """
    try:
        for scope in scopes:
            await with_blobs(blobs, blobs.erase, scope)
    except BlobsUnavailableError as error:
        raise problem_error(
            slug="not-ready",
            code="storage-unavailable",
            detail="It is not found any more, but the storage is not available: its files are "
            "erased once that is back.",
            remedy="Nothing has to be sent again.",
        ) from error
