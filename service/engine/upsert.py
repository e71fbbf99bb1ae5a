"""Inserts that may meet a row that is there: SQLite and Postgres each have their own."""

import sqlalchemy as sa
from sqlalchemy.dialects import postgresql, sqlite


def insert_or_update(
    connection: sa.Connection, table: sa.Table
) -> sqlite.Insert | postgresql.Insert:
    """Begin an insert that can say what becomes of a row with the same key."""
    if connection.dialect.name == "postgresql":
        return postgresql.insert(table)
    return sqlite.insert(table)
