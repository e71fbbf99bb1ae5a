"""Trying again while the database is unavailable."""

from collections.abc import Callable
from typing import Final, ParamSpec, TypeVar

from sqlalchemy.exc import OperationalError
from sqlalchemy.exc import TimeoutError as PoolTimeoutError

from service.process.retrying import retry_with_pauses

ABSENCES: Final = (OperationalError, PoolTimeoutError)
"""While a host cannot be reached, every connection of a pool may be held by who waits for it."""

P = ParamSpec("P")
T = TypeVar("T")


def retry_while_database_is_away(operation: Callable[P, T]) -> Callable[P, T]:
    """Retry an operation that fails because the database is unavailable, for up to two minutes."""
    return retry_with_pauses(ABSENCES, "database")(operation)
