"""Workers: which are alive, and when they look for jobs."""

import errno
import os
import subprocess
import sys
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from types import SimpleNamespace

import pytest

from service.jobs.liveness import WorkerWatch, this_process
from service.jobs.slots import WorkerSlots

DEAD_AFTER_S = 10.0


class Clock:
    def __init__(self) -> None:
        self.now = 1000.0

    def __call__(self) -> float:
        return self.now


def row(
    name: str,
    beat: int,
    *,
    machine: str = "elsewhere",
    pid: int = 1,
    started: str = "",
    able: bool = True,
) -> SimpleNamespace:
    return SimpleNamespace(
        executor_id=name, beat=beat, machine=machine, pid=pid, pid_started=started, able=able
    )


def test_a_worker_seen_for_the_first_time_is_given_the_benefit_of_the_doubt():
    assert WorkerWatch(dead_after_s=DEAD_AFTER_S).alive([row("a", 5)]) == {"a"}


def test_a_worker_is_ready_once_it_is_known_to_be_alive_and_while_it_says_that_it_is_able():
    watch = WorkerWatch(dead_after_s=DEAD_AFTER_S)
    (first,) = watch.look([row("a", 5)])
    (beaten,) = watch.look([row("a", 6)])
    (unable,) = watch.look([row("a", 7, able=False)])
    assert [each.is_ready for each in (first, beaten, unable)] == [False, True, False]


def test_a_worker_whose_beat_stands_still_is_dead_and_one_whose_beat_rises_is_not():
    clock = Clock()
    watch = WorkerWatch(dead_after_s=DEAD_AFTER_S, monotonic=clock)
    watch.alive([row("still", 5), row("rising", 5)])
    for beat in range(6, 12):
        clock.now += 2.0
        alive = watch.alive([row("still", 5), row("rising", beat)])
    assert alive == {"rising"}


def test_silence_shorter_than_the_limit_is_forgiven():
    clock = Clock()
    watch = WorkerWatch(dead_after_s=DEAD_AFTER_S, monotonic=clock)
    watch.alive([row("a", 5)])
    clock.now += DEAD_AFTER_S - 0.1
    assert watch.alive([row("a", 5)]) == {"a"}
    watch.alive([row("a", 6)])
    clock.now += DEAD_AFTER_S - 0.1
    assert watch.alive([row("a", 6)]) == {"a"}


def test_a_worker_of_this_machine_whose_process_is_gone_is_dead_at_once():
    process = subprocess.Popen([sys.executable, "-c", "input()"], stdin=subprocess.PIPE)
    here = this_process()
    stat = Path(f"/proc/{process.pid}/stat").read_text().rpartition(")")[2].split()
    worker = row("a", 5, machine=here["machine"], pid=process.pid, started=stat[19])
    watch = WorkerWatch(dead_after_s=DEAD_AFTER_S)
    assert watch.alive([worker]) == {"a"}
    process.kill()
    # Killed but not yet waited for, it is a zombie: gone all the same.
    os.waitid(os.P_PID, process.pid, os.WEXITED | os.WNOWAIT)
    assert watch.alive([worker]) == set()
    process.communicate()
    assert watch.alive([worker]) == set()


def test_a_process_that_took_over_the_pid_is_not_the_worker():
    here = this_process()
    impostor = row("a", 5, machine=here["machine"], pid=here["pid"], started="1")
    assert WorkerWatch(dead_after_s=DEAD_AFTER_S).alive([impostor]) == set()


def test_the_same_pid_on_another_machine_is_not_looked_up_here():
    assert WorkerWatch(dead_after_s=DEAD_AFTER_S).alive([row("a", 5, pid=2**22)]) == {"a"}


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
