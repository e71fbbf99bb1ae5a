"""Processes kept for the next job: for whom, for how long, and when not."""

import time

from service.numerics.fork_server import Child
from service.numerics.job_lane import JobLane

SHOP, BROWSER, GYM = "shop", "a browser of the shop", "gym"
PATIENCE_S = 60.0


class FakeProcess:
    """A process that is alive until it is killed."""

    def __init__(self) -> None:
        self.is_running = True

    def is_alive(self) -> bool:
        return self.is_running

    def kill(self) -> None:
        self.is_running = False

    def join(self) -> None:
        assert not self.is_running

    def close(self) -> None:
        pass


class FakeConnection:
    """A pipe, and whether something has come through it."""

    def __init__(self) -> None:
        self.has_something = False

    def poll(self) -> bool:
        return self.has_something

    def close(self) -> None:
        pass


def new_child(jobs: int = 1) -> tuple[Child, FakeProcess, FakeConnection]:
    process, connection = FakeProcess(), FakeConnection()
    child = Child(connection, process)  # pyright: ignore
    child.tasks = jobs
    return child, process, connection


def lane(*, jobs: int = 50, kept_s: float = 1.0) -> JobLane:
    """A lane that is asked to start no child."""
    return JobLane(None, None, jobs=jobs, kept_s=kept_s)  # pyright: ignore


def test_a_child_that_ended_well_runs_the_next_job():
    kept = lane(jobs=50)
    first, process, _ = new_child()
    kept.keep(first, SHOP)
    assert kept.take(SHOP) is first
    assert process.is_running
    assert kept.take(SHOP) is None


def test_nobody_elses_job_is_run_by_it():
    for other in (GYM, BROWSER):
        kept = lane(jobs=50)
        first, process, _ = new_child()
        kept.keep(first, SHOP)
        assert kept.take(other) is None
        # It would be one process more than there are slots.
        assert not process.is_running


def test_of_several_the_owners_own_is_taken():
    kept = lane(jobs=50)
    shops, gyms = new_child(), new_child()
    kept.keep(gyms[0], GYM)
    kept.keep(shops[0], SHOP)
    assert kept.take(SHOP) is shops[0]
    assert kept.take(GYM) is gyms[0]


def test_without_a_job_it_ends():
    kept = lane(jobs=50, kept_s=0.01)
    first, process, _ = new_child()
    kept.keep(first, SHOP)
    deadline = time.monotonic() + PATIENCE_S
    while process.is_running and time.monotonic() < deadline:
        time.sleep(0.01)
    assert not process.is_running
    assert kept.take(SHOP) is None


def test_one_that_was_taken_is_not_ended_for_having_waited():
    kept = lane(jobs=50, kept_s=0.5)
    first, process, _ = new_child()
    kept.keep(first, SHOP)
    assert kept.take(SHOP) is first
    time.sleep(0.7)
    assert process.is_running


def test_after_its_last_job_it_ends():
    kept = lane(jobs=3)
    first, process, _ = new_child(jobs=3)
    kept.keep(first, SHOP)
    assert not process.is_running
    assert kept.take(SHOP) is None


def test_one_that_died_while_it_waited_is_not_given_a_job():
    kept = lane(jobs=50)
    first, process, _ = new_child()
    kept.keep(first, SHOP)
    process.is_running = False
    assert kept.take(SHOP) is None


def test_one_that_speaks_unasked_is_not_given_a_job():
    kept = lane(jobs=50)
    first, process, connection = new_child()
    kept.keep(first, SHOP)
    connection.has_something = True
    assert kept.take(SHOP) is None
    assert not process.is_running
