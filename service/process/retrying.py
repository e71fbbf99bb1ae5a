"""Trying again, with pauses, while a database or a storage is unavailable.

An attempt may have minutes of work behind it when the database is locked, restarted or out of
reach, or a disk is full. Its writes are each one transaction and name their attempt, and blobs are
named by their content, so repeating them is safe.
"""

import functools
import logging
import time
from collections.abc import Callable
from typing import Final, ParamSpec, TypeVar

P = ParamSpec("P")
T = TypeVar("T")

LOG: Final = logging.getLogger(__name__)

RETRY_FOR_S: Final = 120.0
FIRST_PAUSE_S: Final = 0.1
LONGEST_PAUSE_S: Final = 2.0


def retry_with_pauses(
    absence: type[Exception] | tuple[type[Exception], ...], whose: str
) -> Callable[[Callable[P, T]], Callable[P, T]]:
    """Retry an operation while something it needs is unavailable, with pauses, for two minutes.

    ``absence`` is the error that says so, ``whose`` names what is missing, for the log.
    """

    def retry(operation: Callable[P, T]) -> Callable[P, T]:
        @functools.wraps(operation)
        def wrapper(*args: P.args, **kwargs: P.kwargs) -> T:
            deadline = time.monotonic() + RETRY_FOR_S
            pause_s = FIRST_PAUSE_S
            while True:
                try:
                    return operation(*args, **kwargs)
                except absence as error:
                    if time.monotonic() >= deadline:
                        raise
                    cause = getattr(error, "orig", error)  # without the SQL
                    LOG.warning("The %s is not available (%s); waiting.", whose, cause)
                time.sleep(pause_s)
                pause_s = min(2.0 * pause_s, LONGEST_PAUSE_S)

        return wrapper

    return retry
