"""Databases of a Postgres server on this machine, made for one run and dropped after it."""

import contextlib
import tempfile
import uuid
from collections.abc import Iterator
from pathlib import Path
from typing import Final

import psycopg
from psycopg import sql

SERVER = "postgresql://postgres@127.0.0.1:5432"

_OPEN_TO_ALL: Final = tempfile.gettempdir()
"""Found before any test makes a work folder, which is for one user alone."""


def server_folder() -> Path:
    """Make a folder for a server of a test's own; its user may enter all that it lies in."""
    return Path(tempfile.mkdtemp(prefix="maquette-postgres-", dir=_OPEN_TO_ALL))


@contextlib.contextmanager
def fresh_database() -> Iterator[str]:
    """Make an empty database and give its address; drop it at the end.

    Raises
    ------
    psycopg.OperationalError
        If no server answers.
    """
    name = f"maquette_test_{uuid.uuid4().hex[:12]}"
    quoted = sql.Identifier(name)
    with administration() as connection:
        connection.execute(sql.SQL("CREATE DATABASE {}").format(quoted))
        try:
            yield f"{SERVER}/{name}"
        finally:
            connection.execute(sql.SQL("DROP DATABASE {} WITH (FORCE)").format(quoted))


def administration() -> psycopg.Connection:
    """A connection beside the databases under test."""
    return psycopg.connect(f"{SERVER}/postgres", autocommit=True, connect_timeout=60)
