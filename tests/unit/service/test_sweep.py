"""What expires is asked with a time that was seen to run evenly; what nobody knows goes."""

from collections.abc import Iterator
from pathlib import Path
from uuid import uuid4

import pytest
import sqlalchemy as sa

from service.jobs.blobs_local import LocalBlobStore
from service.jobs.database import open_database, prepare_database
from service.jobs.executions import client_of
from service.jobs.sweep import (
    SETTLING_S,
    UNKNOWN_KEPT_S,
    ClockGuard,
    Sweeper,
    enter_erasures,
)
from service.jobs.tables import ERASURES
from tests.stored_jobs import insert_job


class Clocks:
    def __init__(self) -> None:
        self.elapsed, self.set_ahead = 100.0, 0.0

    def monotonic(self) -> float:
        return self.elapsed

    def wall(self) -> float:
        return 1_000_000.0 + self.elapsed + self.set_ahead


def test_the_wall_clocks_time_is_given_while_it_runs_evenly():
    clocks = Clocks()
    guard = ClockGuard(wall=clocks.wall, monotonic=clocks.monotonic)
    clocks.elapsed += 5.0
    assert guard.settled_time() == 1_000_105.0


def test_none_is_given_for_a_while_after_a_jump_and_then_that_of_the_new_clock():
    clocks = Clocks()
    guard = ClockGuard(wall=clocks.wall, monotonic=clocks.monotonic)
    clocks.set_ahead = 90_000.0
    assert guard.settled_time() is None
    clocks.elapsed += 0.9 * SETTLING_S
    assert guard.settled_time() is None
    clocks.elapsed += 0.2 * SETTLING_S
    assert guard.settled_time() == clocks.wall()


@pytest.fixture
def database(tmp_path: Path) -> Iterator[sa.Engine]:
    url = f"sqlite:///{tmp_path / 'maquette.sqlite'}"
    prepare_database(url)
    opened = open_database(url)
    yield opened
    opened.dispose()


def test_folders_that_no_record_names_are_erased_after_a_day(database: sa.Engine, tmp_path: Path):
    blobs = LocalBlobStore(tmp_path / "blobs")
    fit, left, submitted = (str(uuid4()) for _ in range(3))
    for scope in (fit, left, submitted, "storage-of", "somebody-elses"):
        blobs.put(scope, b"picture")
    with database.begin() as connection:
        insert_job(connection, fit)
        enter_erasures(connection, [submitted], due_at=4e9)

    def swept() -> int:
        client = client_of(database)
        return Sweeper(database, client, blobs, interval_s=1.0).sweep()

    assert swept() == 0
    assert left in set(blobs.scopes())
    with database.begin() as connection:
        a_day_ago = ERASURES.c.due_at - UNKNOWN_KEPT_S
        connection.execute(sa.update(ERASURES).values(due_at=a_day_ago))
    assert swept() == 1
    assert set(blobs.scopes()) == {fit, submitted, "storage-of", "somebody-elses"}
