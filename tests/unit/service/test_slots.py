"""Whoever looks for jobs waits for minutes, or is let go at once."""

import errno
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager

import pytest

from service.jobs.slots import WorkerSlots

LONG_S = 6_000.0
PATIENCE_S = 600.0


def slots_of(count: int) -> WorkerSlots:
    return WorkerSlots(count, poll_s=LONG_S)


@contextmanager
def waiting(wait: Callable[[], None]) -> Iterator[threading.Thread]:
    """Somebody who waits; is let go before the context ends, or the test fails."""
    thread = threading.Thread(target=wait, daemon=True)
    thread.start()
    yield thread
    thread.join(PATIENCE_S)
    assert not thread.is_alive()


def is_waiting(thread: threading.Thread) -> bool:
    thread.join(0.2)
    return thread.is_alive()


def test_jobs_take_slots_when_they_are_claimed_and_free_them_when_they_end():
    slots = slots_of(2)
    assert slots.vacant() == 2
    slots.take("one")
    assert (slots.vacant(), set(slots.held()), set(slots.not_begun())) == (1, {"one"}, {"one"})
    slots.begin("one")
    assert (slots.vacant(), set(slots.held()), set(slots.not_begun())) == (1, {"one"}, set())
    slots.free("one")
    assert (slots.vacant(), set(slots.held())) == (2, set())


def test_a_look_that_fails_is_logged_and_made_again(
    caplog: pytest.LogCaptureFixture, monkeypatch: pytest.MonkeyPatch
):
    monkeypatch.setattr("service.jobs.slots.FAULT_PAUSE_S", 0.0)
    slots = WorkerSlots(1, poll_s=0.01)
    looks: list[int] = []

    def look() -> bool:
        looks.append(len(looks))
        if len(looks) == 1:
            raise FileNotFoundError(errno.ENOENT, "the data folder is away")
        slots.close()
        return False

    slots.keep_filled(look)
    assert looks == [0, 1]
    assert "the data folder is away" in caplog.text


def test_a_full_worker_waits_until_a_slot_is_left():
    slots = slots_of(1)
    slots.take("one")
    slots.begin("one")
    with waiting(slots.await_vacancy) as waiter:
        assert is_waiting(waiter)
        slots.leave("one")
    assert slots.vacant() == 1


def test_a_slot_that_was_left_is_another_jobs_while_the_result_is_stored():
    slots = slots_of(1)
    slots.begin("one")
    slots.leave("one")
    assert slots.vacant() == 1
    assert set(slots.held()) == {"one"}
    assert not slots.all_left(within_s=0.01)
    slots.free("one")
    assert slots.all_left(within_s=0.0)


def test_no_more_results_are_being_stored_than_there_are_slots():
    slots = slots_of(1)
    for job in ("one", "two"):
        slots.begin(job)
        slots.leave(job)
    assert slots.vacant() == 0
    with waiting(slots.await_vacancy) as waiter:
        assert is_waiting(waiter)
        slots.free("one")


def test_after_a_look_that_found_nothing_the_next_is_a_pause_away():
    slots = slots_of(2)
    with waiting(slots.await_next_look) as waiter:
        assert is_waiting(waiter)
        slots.close()


def test_the_end_of_a_job_is_followed_by_a_look_at_once():
    slots = slots_of(2)
    slots.begin("one")
    with waiting(slots.await_next_look) as waiter:
        assert is_waiting(waiter)
        slots.leave("one")
    # Also if nobody was waiting when it was left.
    slots.free("one")
    with waiting(slots.await_next_look):
        pass


def test_closed_slots_take_nobody_and_wait_for_those_who_have_one():
    slots = slots_of(2)
    slots.begin("one")
    slots.close()
    assert slots.is_closed
    assert slots.vacant() == 0
    with waiting(slots.await_vacancy):
        pass
    assert set(slots.held()) == {"one"}
    assert not slots.all_left(within_s=0.01)
    slots.free("one")
    assert slots.all_left(within_s=0.0)
