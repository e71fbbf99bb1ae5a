"""Waiting for a database that is away."""

from collections.abc import Callable
from typing import ParamSpec, TypeVar

from sqlalchemy.exc import OperationalError

from service.patience import patient_with

P = ParamSpec("P")
T = TypeVar("T")


def patiently(operation: Callable[P, T]) -> Callable[P, T]:
    """Repeat an operation that fails for want of the database, for up to two minutes."""
    return patient_with(OperationalError, "database")(operation)
