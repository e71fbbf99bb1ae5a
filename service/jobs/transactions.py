"""Ways of writing that SQLite and Postgres each have their own kind of; facts about the service."""

import contextlib
from collections.abc import Iterator

import sqlalchemy as sa
from sqlalchemy.dialects import postgresql, sqlite

from service.jobs.tables import FACTS


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
