"""Whether the database is there: what its driver's errors mean, and trying again until it is."""

import functools
import re
import sqlite3
from collections.abc import Callable
from typing import Final, ParamSpec, TypeVar

import psycopg
from sqlalchemy.exc import DBAPIError, OperationalError
from sqlalchemy.exc import TimeoutError as PoolTimeoutError

from service.jobs.port import EngineFullError, EngineUnavailableError
from service.process.retrying import retry_with_pauses

REFUSALS: Final = re.compile(
    r'database ".*" does not exist|role ".*" does not exist|no such (?:database|user)'
    r"|password authentication failed|no password supplied|SASL authentication failed"
    r"|is not permitted to log in|no pg_hba\.conf entry|permission denied for database"
    r"|server does not support SSL|certificate verify failed"
)
"""Refused connections that waiting will not cure. Their SQLSTATE is not available: libpq passes on
only the text. In languages other than English they are not recognised, and are waited for."""

FINAL_STATES: Final = frozenset({"42501", "25006"})
"""SQLSTATE: insufficient privilege, or a read-only server."""

FINAL_SQLITE: Final = frozenset(
    {sqlite3.SQLITE_NOTADB, sqlite3.SQLITE_CORRUPT, sqlite3.SQLITE_READONLY, sqlite3.SQLITE_PERM}
)
PRIMARY_CODE: Final = 0xFF
"""The bits of an extended result code that hold the primary one."""

DISK_FULL: Final = "53100"
FULL_SQLITE: Final = frozenset({sqlite3.SQLITE_IOERR_WRITE, sqlite3.SQLITE_IOERR_SHMSIZE})
"""What SQLite reports, besides SQLITE_FULL, if a file cannot grow: a quota, a file size limit."""


def refusal(error: DBAPIError) -> str | None:
    """Why the database cannot be used as it is, in the driver's words; None if waiting may help."""
    cause = error.orig
    if isinstance(cause, sqlite3.Error):
        return str(cause) if _sqlite_code(cause) & PRIMARY_CODE in FINAL_SQLITE else None
    if not isinstance(cause, psycopg.Error):
        return None
    words = " ".join(str(cause).split())
    if cause.sqlstate is not None:
        return words if cause.sqlstate in FINAL_STATES else None
    is_unreadable = isinstance(cause, psycopg.ProgrammingError)
    if is_unreadable or REFUSALS.search(words):
        return words.rpartition("FATAL:")[2].strip()
    return None


def is_full(error: BaseException) -> bool:
    """Whether the error means that the database's disk is full."""
    cause = getattr(error, "orig", error)
    if isinstance(cause, sqlite3.Error):
        code = _sqlite_code(cause)
        return code & PRIMARY_CODE == sqlite3.SQLITE_FULL or code in FULL_SQLITE
    return isinstance(cause, psycopg.Error) and cause.sqlstate == DISK_FULL


def _sqlite_code(error: sqlite3.Error) -> int:
    return getattr(error, "sqlite_errorcode", 0)


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


ABSENCES: Final = (OperationalError, PoolTimeoutError)
"""While a host cannot be reached, every connection of a pool may be held by who waits for it."""

P = ParamSpec("P")
T = TypeVar("T")


def retry_while_database_is_away(operation: Callable[P, T]) -> Callable[P, T]:
    """Retry an operation that fails because the database is unavailable, for up to two minutes."""
    return retry_with_pauses(ABSENCES, "database")(operation)
