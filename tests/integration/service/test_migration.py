"""Databases of version 1.0 are brought up to date in place, while its processes still run."""

import json
from pathlib import Path

import pytest
import sqlalchemy as sa

from service.engine.database import check_database, open_database, prepare_database
from service.engine.tables import METADATA
from tests.integration.service.harness import Machine

RELEASED: dict[str, list[str]] = json.loads(
    Path(__file__).with_name("tables_of_1_0.json").read_text()
)
"""The columns of each table that 1.0 made, and names when it inserts."""

ADDED = [
    column
    for table in METADATA.sorted_tables
    if table.name in RELEASED
    for column in table.columns
    if column.name not in RELEASED[table.name]
]


@pytest.fixture
def released(machine: Machine) -> str:
    """The address of a database as 1.0 made it, with one fact in it."""
    url = machine.database_url or f"sqlite:///{machine.data_dir / 'maquette.sqlite'}"
    prepare_database(url)
    database = open_database(url, connections=1)
    with database.begin() as connection:
        for column in ADDED:
            connection.execute(
                sa.text(f"ALTER TABLE {column.table.name} DROP COLUMN {column.name}")
            )
        for table in reversed(METADATA.sorted_tables):
            if table.name not in RELEASED:
                connection.execute(sa.text(f"DROP TABLE {table.name}"))
        connection.execute(sa.text("INSERT INTO maquette_facts VALUES ('told', 'by 1.0')"))
    database.dispose()
    return url


def columns(url: str) -> dict[str, set[str]]:
    database = open_database(url, connections=1)
    try:
        inspector = sa.inspect(database)
        return {
            table.name: {column["name"] for column in inspector.get_columns(table.name)}
            for table in METADATA.sorted_tables
            if inspector.has_table(table.name)
        }
    finally:
        database.dispose()


def test_what_a_version_adds_is_added_to_the_tables_of_1_0_and_nothing_is_lost(released: str):
    assert columns(released) == {name: set(there) for name, there in RELEASED.items()}
    check_database(released)
    for _ in range(2):
        prepare_database(released)
        assert columns(released) == {
            table.name: {column.name for column in table.columns}
            for table in METADATA.sorted_tables
        }
    database = open_database(released, connections=1)
    with database.connect() as connection:
        told = connection.execute(
            sa.text("SELECT value FROM maquette_facts WHERE name = 'told'")
        ).scalar_one()
    database.dispose()
    assert told == "by 1.0"


def test_1_0_may_leave_out_every_column_that_it_does_not_know():
    unknown = [str(each) for each in ADDED if not (each.nullable or each.server_default)]
    assert unknown == []
