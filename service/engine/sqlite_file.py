"""The embedded database's file: private to its owner, and set up before its first table."""

import sqlite3
import sys
from pathlib import Path
from typing import Any, Final

import sqlalchemy as sa

from service.engine.port import DatabaseUnusableError
from service.process.data_folder import (
    database_files,
    make_private_file,
    make_private_folder,
    tighten,
)

BUSY_TIMEOUT_MS: Final = 30_000


def check_sqlite_version() -> None:
    """Raise DatabaseUnusableError if this Python's SQLite lacks what DBOS needs."""
    # From Python 3.12 on DBOS reads the clock with unixepoch('subsec'), NULL in an older SQLite.
    if sys.version_info >= (3, 12) and sqlite3.sqlite_version_info < (3, 42):
        message = (
            f"SQLite {sqlite3.sqlite_version} is too old. Use a Python built with SQLite 3.42 or "
            "newer, or set MAQUETTE_DATABASE_URL to a Postgres database."
        )
        raise DatabaseUnusableError(message)


def secure_file(path: Path) -> None:
    """Create the file unless it exists, and deny access to everybody but its owner.

    SQLite gives the files it creates next to it the same mode.
    """
    make_private_folder(path.parent)
    if not path.exists():
        make_private_file(path)
    for each in database_files(path):
        tighten(each)


def configure_connection(connection: Any, _: object) -> None:
    """Set up a new SQLite connection."""
    # IMMEDIATE: a transaction that reads and then writes would otherwise fail instead of waiting.
    connection.isolation_level = "IMMEDIATE"
    for pragma in (
        f"busy_timeout={BUSY_TIMEOUT_MS}",
        "foreign_keys=ON",
        "synchronous=FULL",
        # Erased rows are overwritten, not only unlinked.
        "secure_delete=ON",
    ):
        connection.execute(f"PRAGMA {pragma}")


def prepare_file(engine: sa.Engine) -> None:
    """Set what must be set before the first table exists."""
    # auto_vacuum takes effect only before the first table; DBOS sets neither pragma.
    connection = engine.raw_connection()
    try:
        connection.driver_connection.isolation_level = None  # pyright: ignore
        cursor = connection.cursor()
        cursor.execute("PRAGMA auto_vacuum=INCREMENTAL")
        cursor.execute("PRAGMA journal_mode=WAL")
        cursor.close()
    finally:
        connection.invalidate()
        connection.close()
