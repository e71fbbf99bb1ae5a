"""Facts of the whole service, written by several workers that start at the same moment."""

import threading
from collections.abc import Iterator

import pytest
import sqlalchemy as sa

from service.jobs.database import open_database, prepare_database
from service.jobs.transactions import read_fact, write_fact
from tests.integration.service.harness import PATIENCE_S, Machine

FACT = "something"


@pytest.fixture
def database(machine: Machine) -> Iterator[sa.Engine]:
    url = machine.database_url or f"sqlite:///{machine.data_dir / 'facts.sqlite'}"
    prepare_database(url)
    engine = open_database(url)
    yield engine
    engine.dispose()


def stored(database: sa.Engine) -> str | None:
    with database.connect() as connection:
        return read_fact(connection, FACT)


def test_a_fact_is_written_once_and_again(database: sa.Engine):
    assert stored(database) is None
    for value in ("first", "second"):
        with database.begin() as connection:
            write_fact(connection, FACT, value)
        assert stored(database) == value


def test_of_two_who_write_at_once_none_fails(database: sa.Engine):
    failures: list[Exception] = []

    def write_second() -> None:
        try:
            with database.begin() as connection:
                write_fact(connection, FACT, "second")
        except sa.exc.SQLAlchemyError as error:
            failures.append(error)

    other = threading.Thread(target=write_second)
    with database.begin() as connection:
        write_fact(connection, FACT, "first")
        other.start()
        # It stands before the row that the first has not committed.
        other.join(timeout=0.5)
        assert other.is_alive()
    other.join(timeout=PATIENCE_S)
    assert not failures
    assert stored(database) == "second"
