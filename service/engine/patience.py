"""Waiting for a database that is away.

An attempt may have minutes of work behind it when the database is locked, restarted or out of
reach. Its writes are each one transaction and name their attempt, so repeating them is safe.
"""

import functools
import logging
import time
from collections.abc import Callable
from typing import Final, ParamSpec, TypeVar

from sqlalchemy.exc import OperationalError

P = ParamSpec("P")
T = TypeVar("T")

LOG: Final = logging.getLogger(__name__)

PATIENCE_S: Final = 120.0
FIRST_PAUSE_S: Final = 0.1
LONGEST_PAUSE_S: Final = 2.0


def patiently(operation: Callable[P, T]) -> Callable[P, T]:
    """Repeat an operation that fails for want of the database, for up to two minutes."""

    @functools.wraps(operation)
    def wrapper(*args: P.args, **kwargs: P.kwargs) -> T:
        deadline = time.monotonic() + PATIENCE_S
        pause_s = FIRST_PAUSE_S
        while True:
            try:
                return operation(*args, **kwargs)
            except OperationalError as error:
                if time.monotonic() >= deadline:
                    raise
                LOG.warning("The database is not available (%s); waiting.", error.orig)
            time.sleep(pause_s)
            pause_s = min(2.0 * pause_s, LONGEST_PAUSE_S)

    return wrapper
