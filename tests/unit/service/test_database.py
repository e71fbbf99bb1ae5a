"""The database: refused if damaged or of another version, waited for while away."""

import contextlib
import logging
import sqlite3
from pathlib import Path

import pytest
import sqlalchemy as sa
from sqlalchemy.exc import OperationalError
from sqlalchemy.exc import TimeoutError as PoolTimeoutError

from service.jobs.blobs import BlobsUnavailableError, retry_while_storage_is_away
from service.jobs.blobs_local import LocalBlobStore
from service.jobs.database import open_database, prepare_database, retry_while_database_is_away
from service.jobs.engine import JobEngine
from service.jobs.records import DatabaseUnusableError, EngineDamagedError
from service.process import retrying
from service.settings import Settings


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


def damage(file: Path, table: str) -> None:
    """Overwrite the first pages of a table and its indexes, under whoever has the file open."""
    with contextlib.closing(sqlite3.connect(file)) as connection:
        connection.execute("PRAGMA wal_checkpoint(TRUNCATE)")
        roots = "SELECT rootpage FROM sqlite_master WHERE tbl_name = ?"
        (size,) = connection.execute("PRAGMA page_size").fetchone()
        with file.open("r+b") as pages:
            for (number,) in connection.execute(roots, [table]):
                pages.seek((number - 1) * size)
                pages.write(bytes([0xA5]) * size)
        # Others read again what they have read before.
        connection.execute("UPDATE maquette_facts SET value = value")
        connection.commit()


def test_a_file_that_proves_damaged_is_told_once_and_used_no_more(
    tmp_path: Path, caplog: pytest.LogCaptureFixture
):
    settings = Settings(data_dir=tmp_path)
    prepare_database(settings.system_database_url)
    database = open_database(settings.system_database_url, connections=2)
    engine = JobEngine(database, LocalBlobStore(settings.blob_dir), settings)
    with contextlib.closing(engine), caplog.at_level(logging.WARNING):
        jobs = engine.of("somebody")
        engine.check_writable()
        assert jobs.job("a") is None
        damage(settings.database_file, "maquette_jobs")
        for _ in range(2):
            with pytest.raises(EngineDamagedError):
                jobs.job("a")
            # The page of what it writes is whole.
            with pytest.raises(EngineDamagedError):
                engine.check_writable()
    assert len(caplog.messages) == 1
    assert "damaged" in caplog.messages[0]
    assert "puts a copy of the database back" in caplog.messages[0]


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
