import os
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace

from service.jobs.liveness import WorkerWatch, this_process

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
