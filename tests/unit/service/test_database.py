"""The database: refused if damaged or of another version, waited for while away."""

from pathlib import Path

import pytest
import sqlalchemy as sa
from sqlalchemy.exc import OperationalError
from sqlalchemy.exc import TimeoutError as PoolTimeoutError

from service.jobs.blobs import BlobsUnavailableError, retry_while_storage_is_away
from service.jobs.database import open_database, prepare_database, retry_while_database_is_away
from service.jobs.records import DatabaseUnusableError
from service.process import retrying


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


STATEMENT = "UPDATE"


class Database:
    def __init__(self, failures: int) -> None:
        self.failures = failures

    def write(self, value: int) -> int:
        if self.failures:
            self.failures -= 1
            raise OperationalError(STATEMENT, {}, Exception("database is locked"))
        return value


@pytest.fixture(autouse=True)
def _no_pauses(monkeypatch):
    monkeypatch.setattr(retrying.time, "sleep", lambda _: None)


def test_an_operation_is_repeated_until_the_database_is_back():
    assert retry_while_database_is_away(Database(5).write)(7) == 7


def test_an_operation_that_got_no_connection_is_repeated():
    failures = [PoolTimeoutError("QueuePool limit of size 8 overflow 0 reached")]

    def write() -> int:
        if failures:
            raise failures.pop()
        return 7

    assert retry_while_database_is_away(write)() == 7


def test_repeating_ends(monkeypatch):
    monkeypatch.setattr(retrying, "RETRY_FOR_S", 0.0)
    with pytest.raises(OperationalError):
        retry_while_database_is_away(Database(1).write)(7)


def test_other_errors_are_not_repeated():
    calls = []

    def broken() -> None:
        calls.append(1)
        raise KeyError

    with pytest.raises(KeyError):
        retry_while_database_is_away(broken)()
    assert len(calls) == 1


def test_a_storage_is_waited_for_as_a_database_is():
    failures = [BlobsUnavailableError("full"), BlobsUnavailableError("away")]

    def write(value: int) -> int:
        if failures:
            raise failures.pop()
        return value

    assert retry_while_storage_is_away(write)(7) == 7
