"""Inserts that may find the row already there: SQLite and Postgres each have their own kind."""

import sqlalchemy as sa
from sqlalchemy.dialects import postgresql, sqlite


def insert_or_update(
    connection: sa.Connection, table: sa.Table
) -> sqlite.Insert | postgresql.Insert:
    """Build an insert that can specify what happens to an existing row with the same key."""
    if connection.dialect.name == "postgresql":
        return postgresql.insert(table)
    return sqlite.insert(table)
