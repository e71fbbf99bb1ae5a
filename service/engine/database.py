"""Open and prepare the database: SQLite in WAL mode, or Postgres."""

import sqlite3
import sys
from pathlib import Path
from typing import Any, Final

import sqlalchemy as sa
from dbos import DBOS
from sqlalchemy import event

from service.engine.facts import read_fact, write_fact
from service.engine.patience import patiently
from service.engine.tables import JOBS, METADATA
from service.engine.transactions import read_then_write

BUSY_TIMEOUT_MS: Final = 30_000
MIGRATION_LOCK: Final = 0x6D617175
"""Key of the Postgres advisory lock held while tables are created."""


SCHEMA_VERSION: Final = "4"
SCHEMA_FACT: Final = "schema_version"

POSTGRES_CONNECTION: Final = {
    "connect_timeout": 5,
    # A database host that is gone without a word is noticed in seconds, not in hours.
    "keepalives_idle": 10,
    "keepalives_interval": 5,
    "keepalives_count": 3,
    "tcp_user_timeout": 15_000,
}


class DatabaseUnusableError(Exception):
    """The database cannot be used as it is; the message says what to do."""


def open_database(url: str, *, connections: int = 20) -> sa.Engine:
    """Open a pool of at most ``connections``; creates the folder of an SQLite file, nothing else.

    Statements are logged without their parameters: none of a caller's data gets into a log.
    """
    parsed = sa.make_url(url)
    if parsed.get_backend_name() == "sqlite":
        _check_sqlite_version()
        Path(parsed.database or "").parent.mkdir(parents=True, exist_ok=True)
        engine = sa.create_engine(
            parsed,
            pool_size=connections,
            max_overflow=0,
            pool_timeout=30,
            hide_parameters=True,
        )
        event.listen(engine, "connect", _configure_sqlite)
        return engine
    return sa.create_engine(
        parsed.set(drivername="postgresql+psycopg"),
        pool_size=connections,
        max_overflow=0,
        pool_timeout=30,
        pool_pre_ping=True,
        hide_parameters=True,
        connect_args={
            name: value for name, value in POSTGRES_CONNECTION.items() if name not in parsed.query
        },
    )


@patiently
def prepare_database(url: str) -> None:
    """Create or migrate all tables; safe to run in several processes at once.

    A database that is not there yet is waited for.

    Raises
    ------
    DatabaseUnusableError
        If it is there and cannot be used as it is.
    """
    engine = open_database(url, connections=2)
    try:
        _check_schema(engine)
        if engine.dialect.name == "sqlite":
            _prepare_sqlite_file(engine)
        DBOS.migrate(url)
        with read_then_write(engine) as connection:
            if engine.dialect.name == "postgresql":
                connection.execute(sa.select(sa.func.pg_advisory_xact_lock(MIGRATION_LOCK)))
            METADATA.create_all(connection)
            write_fact(connection, SCHEMA_FACT, SCHEMA_VERSION)
    finally:
        engine.dispose()


def _check_schema(engine: sa.Engine) -> None:
    if not sa.inspect(engine).has_table(JOBS.name):
        return
    with engine.connect() as connection:
        found = read_fact(connection, SCHEMA_FACT)
    if found != SCHEMA_VERSION:
        message = (
            f"The database was made by another version of Maquette (tables {found or '1'}, here "
            f"{SCHEMA_VERSION}). Let its jobs end with that version, then start this one with a "
            "new MAQUETTE_DATA_DIR or MAQUETTE_DATABASE_URL."
        )
        raise DatabaseUnusableError(message)


def _check_sqlite_version() -> None:
    # From Python 3.12 on DBOS reads the clock by unixepoch('subsec'), NULL in an older SQLite.
    if sys.version_info >= (3, 12) and sqlite3.sqlite_version_info < (3, 42):
        message = (
            f"SQLite {sqlite3.sqlite_version} is too old. Use a Python built with SQLite 3.42 or "
            "newer, or set MAQUETTE_DATABASE_URL to a Postgres database."
        )
        raise DatabaseUnusableError(message)


def _configure_sqlite(connection: Any, _: object) -> None:
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


def _prepare_sqlite_file(engine: sa.Engine) -> None:
    # auto_vacuum takes effect only before the first table; DBOS sets neither of the two.
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
