"""Open and prepare the database: SQLite in WAL mode, or Postgres."""

import contextlib
from collections.abc import Iterator
from pathlib import Path
from typing import Final

import sqlalchemy as sa
from sqlalchemy import event
from sqlalchemy.exc import ArgumentError, DBAPIError
from sqlalchemy.schema import CreateColumn

from service.engine.driver_errors import refusal
from service.engine.facts import read_fact, write_fact
from service.engine.port import DatabaseUnusableError
from service.engine.retrying import retry_while_database_is_away
from service.engine.sqlite_file import (
    check_sqlite_version,
    configure_connection,
    prepare_file,
    secure_file,
)
from service.engine.tables import JOBS, METADATA
from service.engine.transactions import read_then_write
from service.setting_addresses import without_secrets

MIGRATION_LOCK: Final = 0x6D617175
"""Key of the Postgres advisory lock held while tables are created and facts are settled."""

SCHEMA_VERSION: Final = "7"
SCHEMA_FACT: Final = "schema_version"

POSTGRES_CONNECTION: Final = {
    "connect_timeout": 5,
    # A database host that vanishes silently is noticed within seconds, not hours.
    "keepalives_idle": 10,
    "keepalives_interval": 5,
    "keepalives_count": 3,
    "tcp_user_timeout": 15_000,
}


def open_database(url: str, *, connections: int = 20) -> sa.Engine:
    """Open a pool of at most ``connections``; creates only the folder of an SQLite file.

    Statements are logged without their parameters, so that no caller's data gets into a log.
    """
    parsed = sa.make_url(url)
    if parsed.get_backend_name() == "sqlite":
        check_sqlite_version()
        secure_file(Path(parsed.database or ""))
        engine = sa.create_engine(
            parsed,
            pool_size=connections,
            max_overflow=0,
            pool_timeout=30,
            hide_parameters=True,
        )
        event.listen(engine, "connect", configure_connection)
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


@retry_while_database_is_away
def check_database(url: str) -> None:
    """Check that the database answers and has no tables of another version.

    Waits for a database that does not answer.

    Raises
    ------
    DatabaseUnusableError
        If it answers but cannot be used as it is.
    """
    with opened(url) as engine:
        _check_schema(engine)


@retry_while_database_is_away
def prepare_database(url: str) -> None:
    """Create or migrate all tables; safe to run in several processes at once.

    Waits and raises as :func:`check_database` does.
    """
    # Imported here because it takes half a second to load.
    from dbos import DBOS

    with opened(url) as engine:
        _check_schema(engine)
        if engine.dialect.name == "sqlite":
            prepare_file(engine)
        DBOS.migrate(url)
        with locked(engine) as connection:
            _bring_up_to_date(connection)
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
        engine = open_database(url, connections=2)
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


def _bring_up_to_date(connection: sa.Connection) -> None:
    """Make the tables that are missing, and add the columns that are missing in others.

    An earlier version did not make them, and its processes may still run. A version only ever adds:
    tables, and columns that may be left out of an insert. Processes of the earlier version go on as
    they are, and can be started again. A change that they could not live with needs another
    ``SCHEMA_VERSION``.
    """
    METADATA.create_all(connection)
    inspector = sa.inspect(connection)
    for table in METADATA.sorted_tables:
        there = {column["name"] for column in inspector.get_columns(table.name)}
        for column in table.columns:
            if column.name not in there:
                _add(connection, column)


def _add(connection: sa.Connection, column: sa.Column[object]) -> None:
    dialect = connection.dialect
    table = dialect.identifier_preparer.format_table(column.table)
    definition = CreateColumn(column).compile(dialect=dialect)
    connection.execute(sa.text(f"ALTER TABLE {table} ADD COLUMN {definition}"))
