"""Tables and columns that an earlier version did not make, while its processes may still run.

A version only ever adds: tables, and columns that may be left out of an insert. Processes of the
earlier version go on as they are, and can be started again. A change that they could not live with
needs another ``SCHEMA_VERSION``.
"""

import sqlalchemy as sa
from sqlalchemy.schema import CreateColumn

from service.engine.tables import METADATA


def bring_up_to_date(connection: sa.Connection) -> None:
    """Make the tables that are missing, and add the columns that are missing in others."""
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
