"""Waiting for a storage that is full or away, as the engine waits for its database."""

import functools
import logging
import time
from collections.abc import Callable
from typing import Final, ParamSpec, TypeVar

from service.blobs import BlobsUnavailableError

P = ParamSpec("P")
T = TypeVar("T")

LOG: Final = logging.getLogger(__name__)

PATIENCE_S: Final = 120.0
FIRST_PAUSE_S: Final = 0.2
LONGEST_PAUSE_S: Final = 5.0


def patient_with_storage(operation: Callable[P, T]) -> Callable[P, T]:
    """Repeat an operation on blobs for up to two minutes: all of them may be repeated."""

    @functools.wraps(operation)
    def wrapper(*args: P.args, **kwargs: P.kwargs) -> T:
        deadline = time.monotonic() + PATIENCE_S
        pause_s = FIRST_PAUSE_S
        while True:
            try:
                return operation(*args, **kwargs)
            except BlobsUnavailableError as error:
                if time.monotonic() >= deadline:
                    raise
                LOG.warning("The storage is not available (%s); waiting.", error)
            time.sleep(pause_s)
            pause_s = min(2.0 * pause_s, LONGEST_PAUSE_S)

    return wrapper
