"""A database of another version, or a damaged one, is refused with one sentence."""

from pathlib import Path

import pytest
import sqlalchemy as sa

from service.jobs.database import open_database, prepare_database
from service.jobs.records import DatabaseUnusableError


def test_tables_of_another_version_are_refused(tmp_path: Path):
    url = f"sqlite:///{tmp_path / 'maquette.sqlite'}"
    for _ in range(2):
        prepare_database(url)
    database = open_database(url, connections=1)
    with database.begin() as connection:
        connection.execute(
            sa.text("UPDATE maquette_facts SET value = '7' WHERE name = 'schema_version'")
        )
    database.dispose()
    with pytest.raises(DatabaseUnusableError, match="tables 7, here 10") as refused:
        prepare_database(url)
    assert "\n" not in str(refused.value)


def test_a_damaged_file_is_refused_before_anything_starts(tmp_path: Path):
    url = f"sqlite:///{tmp_path / 'maquette.sqlite'}"
    prepare_database(url)
    file = tmp_path / "maquette.sqlite"
    content = bytearray(file.read_bytes())
    page = 4096
    content[page * 5 : page * 6] = bytes([0xA5]) * page
    file.write_bytes(content)
    with pytest.raises(DatabaseUnusableError, match=r"MAQUETTE_DATA_DIR=.*(damaged|malformed)"):
        prepare_database(url)
