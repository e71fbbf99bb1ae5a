"""One way to report that the database is unavailable."""

import functools
from collections.abc import Callable
from typing import ParamSpec, TypeVar

from sqlalchemy.exc import OperationalError
from sqlalchemy.exc import TimeoutError as PoolTimeoutError

from service.engine.driver_errors import is_full
from service.engine.port import EngineFullError, EngineUnavailableError

P = ParamSpec("P")
T = TypeVar("T")


def available(operation: Callable[P, T]) -> Callable[P, T]:
    """Turn errors of the database's driver into the port's own."""

    @functools.wraps(operation)
    def wrapper(*args: P.args, **kwargs: P.kwargs) -> T:
        try:
            return operation(*args, **kwargs)
        except (OperationalError, PoolTimeoutError) as error:
            kind = EngineFullError if is_full(error) else EngineUnavailableError
            raise kind from error

    return wrapper
