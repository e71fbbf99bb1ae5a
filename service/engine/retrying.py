"""Trying again while the database is unavailable."""

from collections.abc import Callable
from typing import ParamSpec, TypeVar

from sqlalchemy.exc import OperationalError

from service.process.retrying import retry_with_pauses

P = ParamSpec("P")
T = TypeVar("T")


def retry_while_database_is_away(operation: Callable[P, T]) -> Callable[P, T]:
    """Retry an operation that fails because the database is unavailable, for up to two minutes."""
    return retry_with_pauses(OperationalError, "database")(operation)
