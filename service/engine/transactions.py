"""Transactions whose writes depend on what they have read."""

import contextlib
from collections.abc import Iterator

import sqlalchemy as sa


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
