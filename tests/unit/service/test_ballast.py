"""Room held back on a real disk of a few megabytes, and given up to a real SQLite."""

import sqlite3
from collections.abc import Iterator
from pathlib import Path

import pytest
import sqlalchemy as sa
from sqlalchemy.exc import OperationalError

from service.engine.availability import available
from service.engine.ballast import PIECE_BYTES, WHOLE_BYTES, Ballast
from service.engine.driver_errors import is_full
from service.engine.port import EngineFullError
from tests.small_disk import SmallDisk, small_disk

STATEMENT = "DELETE"


@pytest.fixture
def disk(tmp_path: Path) -> Iterator[SmallDisk]:
    try:
        with small_disk(tmp_path / "disk", megabytes=40) as mounted:
            yield mounted
    except PermissionError as error:
        pytest.skip(f"no disk can be mounted here ({error})")


@pytest.fixture
def database(disk: SmallDisk) -> Iterator[sa.Engine]:
    engine = sa.create_engine(f"sqlite:///{disk.folder}/some.sqlite")
    with engine.begin() as connection:
        connection.execute(sa.text("PRAGMA journal_mode=WAL"))
        connection.execute(sa.text("CREATE TABLE kept (number INTEGER, content BLOB)"))
        for number in range(50):
            connection.execute(
                sa.text("INSERT INTO kept VALUES (:number, randomblob(50000))"), {"number": number}
            )
    with engine.connect() as connection:
        connection.execute(sa.text("PRAGMA wal_checkpoint(TRUNCATE)"))
    yield engine
    engine.dispose()


def held(disk: SmallDisk) -> int:
    return (disk.folder / "ballast").stat().st_blocks * 512


def erase(database: sa.Engine) -> int:
    with database.begin() as connection:
        connection.execute(sa.text("PRAGMA secure_delete=ON"))
        return connection.execute(sa.text("DELETE FROM kept WHERE number < 10")).rowcount


def test_it_takes_room_and_gives_up_as_much_as_the_erasing_needs(
    disk: SmallDisk, database: sa.Engine
):
    ballast = Ballast(disk.folder / "ballast")
    ballast.fill()
    assert held(disk) == WHOLE_BYTES
    disk.leave(0)
    with pytest.raises(OperationalError):
        erase(database)
    assert ballast.spend_on(lambda: erase(database)) == 10
    assert 0 < held(disk) < WHOLE_BYTES
    disk.clear()
    ballast.fill()
    assert held(disk) == WHOLE_BYTES


def test_it_never_takes_more_than_half_of_what_is_free(disk: SmallDisk):
    disk.leave(5 * PIECE_BYTES)
    ballast = Ballast(disk.folder / "ballast")
    ballast.fill()
    assert held(disk) == 2 * PIECE_BYTES
    disk.leave(0)
    ballast.fill()
    assert held(disk) == 2 * PIECE_BYTES


def test_room_is_made_on_a_disk_without_any(disk: SmallDisk):
    ballast = Ballast(disk.folder / "ballast")
    ballast.fill()
    disk.leave(0)
    ballast.make_room()
    assert disk.free_bytes >= PIECE_BYTES
    assert held(disk) == WHOLE_BYTES - PIECE_BYTES


def test_without_ballast_the_error_says_that_the_disk_is_full(disk: SmallDisk, database: sa.Engine):
    disk.leave(0)
    with pytest.raises(OperationalError) as error:
        Ballast(None).spend_on(lambda: erase(database))
    assert is_full(error.value)
    with pytest.raises(EngineFullError):
        available(erase)(database)


def test_another_fault_gives_nothing_up(tmp_path: Path):
    ballast = Ballast(tmp_path / "ballast")
    ballast.fill()

    def fail() -> None:
        raise OperationalError(STATEMENT, {}, sqlite3.OperationalError("database is locked"))

    with pytest.raises(OperationalError):
        ballast.spend_on(fail)
    assert (tmp_path / "ballast").stat().st_size == WHOLE_BYTES
