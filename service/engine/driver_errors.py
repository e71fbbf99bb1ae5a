"""What the errors of a database's driver mean: away, full, or of no use however long one waits."""

import re
import sqlite3
from typing import Final

import psycopg
from sqlalchemy.exc import DBAPIError

REFUSALS: Final = re.compile(
    r'database ".*" does not exist|role ".*" does not exist|no such (?:database|user)'
    r"|password authentication failed|no password supplied|SASL authentication failed"
    r"|is not permitted to log in|no pg_hba\.conf entry|permission denied for database"
    r"|server does not support SSL|certificate verify failed"
)
"""Answers to a connection that no waiting will change. Their SQLSTATE is not to be had: libpq gives
the words alone. In another language than English they are not known, and are waited for."""

FINAL_STATES: Final = frozenset({"42501", "25006"})
"""SQLSTATE: no right to do so, or a server that only reads."""

FINAL_SQLITE: Final = frozenset(
    {sqlite3.SQLITE_NOTADB, sqlite3.SQLITE_CORRUPT, sqlite3.SQLITE_READONLY, sqlite3.SQLITE_PERM}
)
PRIMARY_CODE: Final = 0xFF
"""The bits of an extended result code that hold the primary one."""

DISK_FULL: Final = "53100"
FULL_SQLITE: Final = frozenset({sqlite3.SQLITE_IOERR_WRITE, sqlite3.SQLITE_IOERR_SHMSIZE})
"""What SQLite says beside SQLITE_FULL where a file cannot grow: a quota, a limit on files."""


def refusal(error: DBAPIError) -> str | None:
    """Why the database cannot be used as it is, in its own words; None if waiting may help."""
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
    """Whether it failed because the database's disk has no room."""
    cause = getattr(error, "orig", error)
    if isinstance(cause, sqlite3.Error):
        code = _sqlite_code(cause)
        return code & PRIMARY_CODE == sqlite3.SQLITE_FULL or code in FULL_SQLITE
    return isinstance(cause, psycopg.Error) and cause.sqlstate == DISK_FULL


def _sqlite_code(error: sqlite3.Error) -> int:
    return getattr(error, "sqlite_errorcode", 0)
