"""Transactions that write what follows from what they have read."""

import contextlib
from collections.abc import Iterator

import sqlalchemy as sa


@contextlib.contextmanager
def read_then_write(database: sa.Engine) -> Iterator[sa.Connection]:
    """Begin a transaction whose rows read ``FOR UPDATE`` stay as they are until it ends.

    Postgres holds these rows. SQLite knows no such clause, and a transaction there begins only with
    the first statement that writes: what was read before may be gone by then. So its one lock
    for writers is taken before anything is read.
    """
    with database.begin() as connection:
        if connection.dialect.name == "sqlite":
            connection.execute(sa.text("BEGIN IMMEDIATE"))
        yield connection
