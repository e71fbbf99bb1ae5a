"""The database, SQLite in WAL mode or Postgres: opened, prepared, and what its errors mean."""

import contextlib
import functools
import logging
import re
import sqlite3
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any, Final, ParamSpec, TypeVar

import psycopg
import sqlalchemy as sa
from sqlalchemy import event
from sqlalchemy.dialects import postgresql, sqlite
from sqlalchemy.exc import ArgumentError, DBAPIError, OperationalError
from sqlalchemy.exc import TimeoutError as PoolTimeoutError

from service.jobs.records import (
    DatabaseUnusableError,
    EngineDamagedError,
    EngineFullError,
    EngineUnavailableError,
)
from service.jobs.tables import FACTS, JOBS, METADATA
from service.process.data_folder import (
    database_files,
    make_private_file,
    make_private_folder,
    tighten,
)
from service.process.retrying import retry_with_pauses
from service.settings import without_secrets

P = ParamSpec("P")
T = TypeVar("T")

LOG: Final = logging.getLogger(__name__)

MIGRATION_LOCK: Final = 0x6D617175
"""Key of the Postgres advisory lock held while tables are created and facts are settled."""

SCHEMA_VERSION: Final = "10"
SCHEMA_FACT: Final = "schema_version"
BODY_MODELS_FACT: Final = "body_models"
"""Name of the fact that says, as JSON, what the worker that last started can fit."""

WAIT_S: Final = 10
"""Longest time for a statement, locks included, and longest wait for a free connection, seconds.
After that a caller is told, and a worker tries again."""

POSTGRES_CONNECTION: Final = {
    "connect_timeout": 5,
    # A database host that vanishes silently is noticed within seconds, not hours.
    "keepalives_idle": 10,
    "keepalives_interval": 5,
    "keepalives_count": 3,
    "tcp_user_timeout": 15_000,
}


ABSENCES: Final = (OperationalError, PoolTimeoutError)
"""While a host cannot be reached, every connection of a pool may be held by who waits for it."""

retry_while_database_is_away = retry_with_pauses(ABSENCES, "database")
"""Retries an operation that fails because the database is unavailable, for up to two minutes."""


def open_database(url: str, *, connections: int = 20) -> sa.Engine:
    """Open a pool of at most ``connections``; creates only the folder of an SQLite file.

    Statements are logged without their parameters, so that no caller's data gets into a log.
    """
    engine = _pool(url, connections=connections)
    leave_when_damaged(engine)
    return engine


def _pool(url: str, *, connections: int) -> sa.Engine:
    parsed = sa.make_url(url)
    pool: dict[str, Any] = {
        "pool_size": connections,
        "max_overflow": 0,
        "pool_timeout": WAIT_S,
        "hide_parameters": True,
    }
    if parsed.get_backend_name() == "sqlite":
        check_sqlite_version()
        secure_file(Path(parsed.database or ""))
        engine = sa.create_engine(parsed, **pool)
        event.listen(engine, "connect", configure_connection)
        return engine
    engine = sa.create_engine(
        parsed.set(drivername="postgresql+psycopg"),
        **pool,
        pool_pre_ping=True,
        connect_args={
            name: value for name, value in POSTGRES_CONNECTION.items() if name not in parsed.query
        },
    )
    event.listen(engine, "connect", limit_statements)
    return engine


@retry_while_database_is_away
def prepare_database(url: str) -> None:
    """Create all tables; safe to run in several processes at once.

    Waits for a database that does not answer.

    Raises
    ------
    DatabaseUnusableError
        If it answers but cannot be used as it is: damaged, or with tables of another version.
    """
    # Imported here because it takes half a second to load.
    from dbos import DBOS

    with opened(url) as engine:
        if engine.dialect.name == "sqlite":
            with engine.connect() as connection:
                found = connection.execute(sa.text("PRAGMA quick_check(1)")).scalar_one()
            if found != "ok":
                raise _unusable(url, f"it is damaged: {found}")
        _check_schema(engine)
        if engine.dialect.name == "sqlite":
            prepare_file(engine)
        DBOS.migrate(url)
        with locked(engine) as connection:
            METADATA.create_all(connection)
            write_fact(connection, SCHEMA_FACT, SCHEMA_VERSION)


@contextlib.contextmanager
def locked(engine: sa.Engine) -> Iterator[sa.Connection]:
    """Begin a transaction that no other process can be in at the same time."""
    with read_then_write(engine) as connection:
        if engine.dialect.name == "postgresql":
            connection.execute(sa.select(sa.func.pg_advisory_xact_lock(MIGRATION_LOCK)))
        yield connection


@contextlib.contextmanager
def opened(url: str) -> Iterator[sa.Engine]:
    """Open the database briefly; errors that waiting cannot cure name its address."""
    try:
        # Without a word of damage: whoever starts says so in its own line.
        engine = _pool(url, connections=2)
    except ArgumentError as error:
        raise _unusable(url, "it cannot be read") from error
    try:
        yield engine
    except DBAPIError as error:
        reason = refusal(error)
        if reason is None:
            raise
        raise _unusable(url, reason) from error
    finally:
        engine.dispose()


def _unusable(url: str, reason: str) -> DatabaseUnusableError:
    if url.startswith("sqlite"):
        file = Path(url.partition("///")[2])
        return DatabaseUnusableError(
            f"MAQUETTE_DATA_DIR={file.parent}: its {file.name} cannot be used ({reason}); put a "
            "copy back that can be, let the user that runs the service own it, or choose another "
            "folder"
        )
    return DatabaseUnusableError(
        f"MAQUETTE_DATABASE_URL={without_secrets(url)}: the database cannot be used ({reason}); "
        "correct address, name, user or password, or have the database made and its rights given"
    )


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


def limit_statements(connection: Any, _: object) -> None:
    """Set up a new connection of Postgres."""
    # Not by the option of a connection, which poolers refuse.
    connection.execute(f"SET statement_timeout = '{WAIT_S}s'")
    connection.commit()


def configure_connection(connection: Any, _: object) -> None:
    """Set up a new SQLite connection."""
    # IMMEDIATE: a transaction that reads and then writes would otherwise fail instead of waiting.
    connection.isolation_level = "IMMEDIATE"
    for pragma in (
        f"busy_timeout={1_000 * WAIT_S}",
        "foreign_keys=ON",
        "synchronous=FULL",
        # Erased rows are overwritten, not only unlinked.
        "secure_delete=ON",
    ):
        connection.execute(f"PRAGMA {pragma}")


def leave_when_damaged(engine: sa.Engine) -> None:
    """Have a file that proves damaged used no more: to everybody the database is away then."""
    found: list[BaseException] = []

    def note(context: sa.engine.ExceptionContext) -> OperationalError | None:
        cause = context.original_exception
        if not _is_damage(cause):
            return None
        if not found:
            found.append(cause)
            LOG.critical("The database is damaged (%s). %s", cause, DAMAGE_REMEDY)
        return OperationalError(None, None, cause)

    def refuse(*_: object) -> None:
        if found:
            raise found[0].with_traceback(None)

    event.listen(engine, "handle_error", note, retval=True)
    event.listen(engine, "checkout", refuse)


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


@contextlib.contextmanager
def read_then_write(database: sa.Engine) -> Iterator[sa.Connection]:
    """Begin a transaction in which rows read ``FOR UPDATE`` cannot change until it ends.

    Postgres locks these rows. SQLite has no such clause, and a transaction there begins only with
    the first write: what was read before may be gone by then. So its single writer lock is taken
    before anything is read.
    """
    with database.begin() as connection:
        if connection.dialect.name == "sqlite":
            connection.execute(sa.text("BEGIN IMMEDIATE"))
        yield connection


def insert_or_update(
    connection: sa.Connection, table: sa.Table
) -> sqlite.Insert | postgresql.Insert:
    """Build an insert that can specify what happens to an existing row with the same key."""
    if connection.dialect.name == "postgresql":
        return postgresql.insert(table)
    return sqlite.insert(table)


def read_fact(connection: sa.Connection, name: str) -> str | None:
    """Return the value stored under a name, None if there is none."""
    query = sa.select(FACTS.c.value).where(FACTS.c.name == name)
    return connection.execute(query).scalar_one_or_none()


def write_fact(connection: sa.Connection, name: str, value: str) -> None:
    """Store a value, replacing any earlier one; of several concurrent writers the last one wins."""
    insert = insert_or_update(connection, FACTS).values(name=name, value=value)
    connection.execute(
        insert.on_conflict_do_update(
            index_elements=[FACTS.c.name], set_={"value": insert.excluded.value}
        )
    )


def touch_fact(connection: sa.Connection, name: str) -> None:
    """Write a fact again unchanged: raises if the database takes no writes."""
    connection.execute(sa.update(FACTS).where(FACTS.c.name == name).values(name=FACTS.c.name))


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

DAMAGED_SQLITE: Final = frozenset({sqlite3.SQLITE_NOTADB, sqlite3.SQLITE_CORRUPT})
DAMAGE_REMEDY: Final = "Whoever runs the service stops it and puts a copy of the database back."
FINAL_SQLITE: Final = DAMAGED_SQLITE | {sqlite3.SQLITE_READONLY, sqlite3.SQLITE_PERM}
PRIMARY_CODE: Final = 0xFF
"""The bits of an extended result code that hold the primary one."""

DISK_FULL: Final = "53100"
FULL_SQLITE: Final = frozenset({sqlite3.SQLITE_IOERR_WRITE, sqlite3.SQLITE_IOERR_SHMSIZE})
"""Errors of SQLite, besides SQLITE_FULL, if a file cannot grow: a quota, a file size limit."""


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


def _is_damage(cause: object) -> bool:
    return isinstance(cause, sqlite3.Error) and _sqlite_code(cause) & PRIMARY_CODE in DAMAGED_SQLITE


def _sqlite_code(error: sqlite3.Error) -> int:
    return getattr(error, "sqlite_errorcode", 0)


def available(operation: Callable[P, T]) -> Callable[P, T]:
    """Turn errors of the database's driver into the port's own."""

    @functools.wraps(operation)
    def wrapper(*args: P.args, **kwargs: P.kwargs) -> T:
        try:
            return operation(*args, **kwargs)
        except ABSENCES as error:
            if _is_damage(getattr(error, "orig", None)):
                raise EngineDamagedError from error
            kind = EngineFullError if is_full(error) else EngineUnavailableError
            raise kind from error

    return wrapper
