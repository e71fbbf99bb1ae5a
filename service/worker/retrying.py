"""Trying again while the storage is full or unavailable."""

from collections.abc import Callable
from typing import ParamSpec, TypeVar

from service.blobs import BlobsUnavailableError
from service.process.retrying import retry_with_pauses

P = ParamSpec("P")
T = TypeVar("T")


def retry_while_storage_is_away(operation: Callable[P, T]) -> Callable[P, T]:
    """Retry an operation on blobs for up to two minutes; all of them are safe to repeat."""
    return retry_with_pauses(BlobsUnavailableError, "storage")(operation)
