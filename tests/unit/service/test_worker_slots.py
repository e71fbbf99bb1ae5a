"""Who looks for jobs waits for a turn: threads that wait for minutes, or are let go at once."""

import threading
from collections.abc import Iterator
from contextlib import contextmanager

from service.engine import worker_slots
from service.engine.worker_slots import SETTLING_S, WorkerSlots

LONG_S = 6_000.0
PATIENCE_S = 600.0


@contextmanager
def waiting(slots: WorkerSlots) -> Iterator[threading.Thread]:
    """Somebody who waits for a turn; gets it before the context ends, or the test fails."""
    thread = threading.Thread(target=slots.await_turn, daemon=True)
    thread.start()
    yield thread
    thread.join(PATIENCE_S)
    assert not thread.is_alive()


def is_waiting(thread: threading.Thread) -> bool:
    thread.join(0.2)
    return thread.is_alive()


def test_with_room_the_next_look_is_a_pause_away():
    slots = WorkerSlots(2, poll_s=LONG_S)
    with slots.taken_by("one"), waiting(slots) as waiter:
        assert is_waiting(waiter)
        slots.close()


def test_the_end_of_a_job_gives_a_turn_at_once():
    # With a clock that stands still, whoever comes to wait only after the end is let go as well.
    slots = WorkerSlots(2, poll_s=LONG_S, monotonic=lambda: 5.0)
    with waiting(slots) as waiter, slots.taken_by("one"):
        assert is_waiting(waiter)


def test_just_after_an_end_nobody_waits():
    slots = WorkerSlots(1, poll_s=LONG_S, monotonic=lambda: 5.0)
    with slots.taken_by("one"):
        pass
    with waiting(slots):
        pass


def test_some_time_after_an_end_the_pace_is_kept_again():
    now = 5.0
    slots = WorkerSlots(1, poll_s=LONG_S, monotonic=lambda: now)
    with slots.taken_by("one"):
        pass
    now += 2.0 * SETTLING_S
    with waiting(slots) as waiter:
        assert is_waiting(waiter)
        slots.close()


def test_a_full_worker_waits_for_a_slot_and_not_for_the_pace(monkeypatch):
    monkeypatch.setattr(worker_slots, "FULL_LOOK_S", LONG_S)
    slots = WorkerSlots(1, poll_s=0.0)
    given = threading.Event()

    def look() -> None:
        slots.await_turn()
        given.set()

    with slots.taken_by("one"):
        threading.Thread(target=look, daemon=True).start()
        assert not given.wait(0.2)
    assert given.wait(PATIENCE_S)


def test_a_full_worker_is_given_a_turn_in_the_end():
    slots = WorkerSlots(1, poll_s=LONG_S)
    with slots.taken_by("one"), waiting(slots):
        pass


def test_closed_places_keep_nobody_waiting_and_wait_for_those_who_have_one():
    slots = WorkerSlots(2, poll_s=LONG_S)
    with slots.taken_by("one"):
        slots.close()
        with waiting(slots):
            pass
        assert set(slots.held()) == {"one"}
        assert not slots.all_left(within_s=0.01)
    assert slots.all_left(within_s=0.0)
    assert set(slots.held()) == set()


def test_a_slot_that_was_left_is_another_jobs_while_the_result_is_stored():
    slots = WorkerSlots(1, poll_s=LONG_S, monotonic=lambda: 5.0)
    with slots.taken_by("one"):
        slots.leave("one")
        with waiting(slots):
            pass
        # The engine has begun one, which it still counts.
        assert slots.claimable() == 2
        slots.end_look()
        assert set(slots.held()) == {"one"}
        assert not slots.all_left(within_s=0.01)
    assert slots.all_left(within_s=0.0)
    assert slots.claimable() == 1


def test_no_more_results_are_being_stored_than_there_are_slots(monkeypatch):
    monkeypatch.setattr(worker_slots, "FULL_LOOK_S", LONG_S)
    slots = WorkerSlots(1, poll_s=0.0)
    with slots.taken_by("one"), slots.taken_by("two"):
        slots.leave("one")
        slots.leave("two")
        assert slots.claimable() == 2
        slots.end_look()
        thread = threading.Thread(target=slots.await_turn, daemon=True)
        thread.start()
        assert is_waiting(thread)
    thread.join(PATIENCE_S)
    assert not thread.is_alive()


def test_a_job_that_a_look_has_counted_does_not_end_during_it(monkeypatch):
    monkeypatch.setattr(worker_slots, "FULL_LOOK_S", LONG_S)
    slots = WorkerSlots(1, poll_s=LONG_S)

    def run() -> None:
        with slots.taken_by("one"):
            slots.leave("one")
            assert slots.claimable() == 2

    thread = threading.Thread(target=run, daemon=True)
    thread.start()
    assert is_waiting(thread)
    slots.end_look()
    thread.join(PATIENCE_S)
    assert not thread.is_alive()
