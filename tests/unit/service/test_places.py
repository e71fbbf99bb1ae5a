"""Who looks for jobs waits for a turn: threads that wait for minutes, or are let go at once."""

import threading
from collections.abc import Iterator
from contextlib import contextmanager

from service.engine.places import FULL_LOOK_S, SETTLING_S, Places

LONG_S = 600.0
PATIENCE_S = 60.0


@contextmanager
def waiting(places: Places) -> Iterator[threading.Thread]:
    """Somebody who waits for a turn; gets it before the context ends, or the test fails."""
    thread = threading.Thread(target=places.await_turn, daemon=True)
    thread.start()
    yield thread
    thread.join(PATIENCE_S)
    assert not thread.is_alive()


def is_waiting(thread: threading.Thread) -> bool:
    thread.join(0.2)
    return thread.is_alive()


def test_with_room_the_next_look_is_a_pause_away():
    places = Places(2, poll_s=LONG_S)
    with places.taken_by("one"), waiting(places) as waiter:
        assert is_waiting(waiter)
        places.close()


def test_the_end_of_a_job_gives_a_turn_at_once():
    places = Places(2, poll_s=LONG_S)
    with waiting(places) as waiter, places.taken_by("one"):
        assert is_waiting(waiter)


def test_just_after_an_end_nobody_waits():
    places = Places(1, poll_s=LONG_S, monotonic=lambda: 5.0)
    with places.taken_by("one"):
        pass
    with waiting(places):
        pass


def test_some_time_after_an_end_the_pace_is_kept_again():
    now = 5.0
    places = Places(1, poll_s=LONG_S, monotonic=lambda: now)
    with places.taken_by("one"):
        pass
    now += 2.0 * SETTLING_S
    with waiting(places) as waiter:
        assert is_waiting(waiter)
        places.close()


def test_a_full_worker_waits_for_a_place_and_not_for_the_pace():
    places = Places(1, poll_s=0.0)
    given = threading.Event()

    def look() -> None:
        places.await_turn()
        given.set()

    with places.taken_by("one"):
        threading.Thread(target=look, daemon=True).start()
        assert not given.wait(0.2 * FULL_LOOK_S)
    assert given.wait(PATIENCE_S)


def test_a_full_worker_is_given_a_turn_in_the_end():
    places = Places(1, poll_s=LONG_S)
    with places.taken_by("one"), waiting(places):
        pass


def test_closed_places_keep_nobody_waiting_and_wait_for_those_who_have_one():
    places = Places(2, poll_s=LONG_S)
    with places.taken_by("one"):
        places.close()
        with waiting(places):
            pass
        assert set(places.held()) == {"one"}
        assert not places.all_left(within_s=0.01)
    assert places.all_left(within_s=0.0)
    assert set(places.held()) == set()
