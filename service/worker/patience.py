"""Waiting for a storage that is full or away."""

from collections.abc import Callable
from typing import ParamSpec, TypeVar

from service.blobs import BlobsUnavailableError
from service.patience import patient_with

P = ParamSpec("P")
T = TypeVar("T")


def patient_with_storage(operation: Callable[P, T]) -> Callable[P, T]:
    """Repeat an operation on blobs for up to two minutes: all of them may be repeated."""
    return patient_with(BlobsUnavailableError, "storage")(operation)
