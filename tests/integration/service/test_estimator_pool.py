"""Estimator processes: asked by many, killed, stuck, replaced, and gone with their API."""

import os
import signal
import subprocess
import sys
import threading
from pathlib import Path

import pytest

from api_schemas.bodies import BodyRequest
from fitter.vocabulary.choices import Gender
from service.estimates import pool as pools
from service.estimates import process as processes
from service.estimates.messages import BodyTask, ConversionTask
from service.estimates.pool import EstimatorPool
from service.estimates.port import (
    EstimatorFailedError,
    EstimatorTimeoutError,
    EstimatorUnavailableError,
)
from service.estimates.starting import by_command, by_passing_on
from service.process.supervisor import SupervisedWorker
from service.startup.begin import UNUSABLE_SETTINGS
from service.submissions.refusal import RefusedError
from tests.integration.service.fake_answers import GATE, GLB
from tests.integration.service.harness import PATIENCE_S, REPOSITORY, eventually, is_running
from tests.process_table import processes_with

COMMAND = (sys.executable, "-m", "tests.integration.service.fake_estimator")
FAKE_WORKER = (sys.executable, "-m", "tests.integration.service.fake_worker")


def task(*, with_glb: bool = False, **script: float) -> BodyTask:
    request = BodyRequest(gender=Gender.MALE, measurements=dict(script))
    return BodyTask(request=request, with_glb=with_glb)


@pytest.fixture(autouse=True)
def patience(monkeypatch):
    monkeypatch.setattr(processes, "READY_WITHIN_S", PATIENCE_S)
    monkeypatch.setattr(processes, "ANSWER_WITHIN_S", PATIENCE_S)
    # Whoever looks after idle processes holds one for a moment: the order of answers is ours.
    monkeypatch.setattr(pools, "LOOK_AFTER_S", PATIENCE_S)


@pytest.fixture
def gate(tmp_path):
    """A file that lets go what waits at the gate, once it exists."""
    return tmp_path / "gate"


@pytest.fixture
def pool(monkeypatch, gate):
    monkeypatch.chdir(REPOSITORY)
    start = by_command(COMMAND, environment=os.environ | {GATE: str(gate)})
    running = EstimatorPool(start, processes=2)
    yield running
    running.stop()


@pytest.fixture
def watched_pool(monkeypatch, request):
    """A pool whose idle processes are looked after all the time."""
    monkeypatch.setattr(pools, "LOOK_AFTER_S", 0.05)
    return request.getfixturevalue("pool")


def estimators(gate: Path) -> set[int]:
    """The processes that were told of the gate: those of one pool."""
    return {each.pid for each in processes_with(GATE, gate)}


def turned_away(pool: EstimatorPool) -> bool:
    try:
        pool.body(task(), patient=False)
    except EstimatorUnavailableError:
        return True
    return False


def answering_pid(pool: EstimatorPool, **script: float) -> int:
    return int(pool.body(task(**script)).estimate.measurements[0].standard_error)


def test_an_answer_comes_with_its_file_where_it_is_asked_for(pool):
    assert pool.body(task(with_glb=True)).glb == GLB
    assert pool.body(task()).glb == b""


def test_a_file_goes_along_with_a_question_however_large_it_is(pool):
    glb = bytes(20_000_000)
    assert pool.convert(ConversionTask(ending="obj"), glb) == b"obj of 20000000 bytes"
    assert pool.body(task()).glb == b""


def test_a_question_at_fault_is_refused_with_its_field(pool):
    with pytest.raises(RefusedError) as caught:
        pool.body(task(girth=3.0))
    assert caught.value.problem.field == "measurements.girth"
    assert caught.value.problem.status == 422


def test_a_fault_in_the_answer_leaves_the_process_as_it_was(pool):
    before = {answering_pid(pool) for _ in range(4)}
    with pytest.raises(EstimatorFailedError):
        pool.body(task(fault=1.0))
    assert {answering_pid(pool) for _ in range(4)} == before


def test_a_question_that_kills_its_process_fails_alone_and_the_process_is_replaced(pool):
    before = {answering_pid(pool) for _ in range(4)}
    for _ in range(3):
        with pytest.raises(EstimatorFailedError):
            pool.body(task(segfault=1.0))
    after = {answering_pid(pool) for _ in range(4)}
    assert len(after) == 2
    assert not any(is_running(pid) for pid in before - after)


def test_a_process_killed_between_questions_is_replaced_unnoticed(pool, monkeypatch):
    monkeypatch.setattr(processes, "RESTART_PAUSE_S", 0.0)
    before = {answering_pid(pool) for _ in range(4)}
    for pid in before:
        os.kill(pid, signal.SIGKILL)
    eventually(lambda: not any(is_running(pid) for pid in before), what="killed")
    assert not {answering_pid(pool) for _ in range(4)} & before


def test_a_question_that_takes_too_long_is_given_up_and_its_process_killed(pool, monkeypatch):
    before = {answering_pid(pool) for _ in range(4)}
    with monkeypatch.context() as impatience:
        impatience.setattr(processes, "ANSWER_WITHIN_S", 0.3)
        with pytest.raises(EstimatorTimeoutError):
            pool.body(task(gate=1.0))
    after = {answering_pid(pool) for _ in range(4)}
    assert len(before & after) == 1
    assert not any(is_running(pid) for pid in before - after)


def test_as_many_are_answered_at_once_as_there_are_processes_and_too_many_are_turned_away(
    pool, gate
):
    answered: list[int] = []
    refused: list[bool] = []

    def ask() -> None:
        try:
            answered.append(answering_pid(pool, gate=1.0))
        except EstimatorUnavailableError:
            refused.append(True)

    assert pool.capacity == 2 * (1 + pools.MOST_WAITING)
    callers = [threading.Thread(target=ask) for _ in range(pool.capacity + 5)]
    for caller in callers:
        caller.start()
    # Nobody is answered before the gate opens, so every place is taken and stays so.
    eventually(lambda: len(refused) == 5, what="those beyond the capacity were turned away")
    assert not answered
    gate.touch()
    for caller in callers:
        caller.join()
    assert (len(answered), len(refused)) == (pool.capacity, 5)
    assert len(set(answered)) == 2


def test_who_is_not_patient_does_not_wait_for_busy_processes(pool, gate):
    held = [
        threading.Thread(target=answering_pid, args=(pool,), kwargs={"gate": 1.0}) for _ in range(2)
    ]
    for caller in held:
        caller.start()
    # Until both hold a process there is one to answer.
    eventually(lambda: turned_away(pool), what="both processes are busy")
    gate.touch()
    for caller in held:
        caller.join()
    assert pool.body(task(), patient=False).estimate


def test_a_process_that_died_is_started_anew_before_it_is_asked(watched_pool, gate, monkeypatch):
    pool = watched_pool
    monkeypatch.setattr(processes, "RESTART_PAUSE_S", 0.0)
    before = eventually(lambda: len(found := estimators(gate)) == 2 and found, what="started")
    for pid in before:
        os.kill(pid, signal.SIGKILL)
    eventually(lambda: not any(is_running(pid) for pid in before), what="killed")
    eventually(lambda: len(estimators(gate) - before) == 2, what="revived")
    assert not {answering_pid(pool) for _ in range(4)} & before


def test_processes_that_cannot_start_say_so_before_the_time_is_up(monkeypatch):
    monkeypatch.chdir(REPOSITORY)
    monkeypatch.setattr(processes, "READY_WITHIN_S", 1e6)
    start = by_command((sys.executable, "-c", "import sys; sys.exit(1)"), environment={})
    broken = EstimatorPool(start, processes=1)
    told: list[Exception] = []

    def ask() -> None:
        try:
            broken.body(task())
        except EstimatorUnavailableError as error:
            told.append(error)

    asking = threading.Thread(target=ask, daemon=True)
    asking.start()
    asking.join(PATIENCE_S)
    assert len(told) == 1
    broken.stop()


def test_estimators_do_not_outlive_their_api(gate):
    program = f"""
import os, time
from service.estimates.pool import EstimatorPool
from service.estimates.starting import by_command
environment = os.environ | {{{GATE!r}: {str(gate)!r}}}
pool = EstimatorPool(by_command({COMMAND!r}, environment=environment), processes=2)
print("started", flush=True)
time.sleep(3600)
"""
    api = subprocess.Popen(
        [sys.executable, "-c", program], cwd=REPOSITORY, stdout=subprocess.PIPE, text=True
    )
    assert api.stdout is not None
    assert api.stdout.readline() == "started\n"
    pids = eventually(lambda: len(found := estimators(gate)) == 2 and found, what="started")
    api.kill()
    api.wait()
    api.stdout.close()
    eventually(lambda: not any(is_running(pid) for pid in pids), what="the estimators ended")


@pytest.fixture
def lending_worker(monkeypatch, gate, tmp_path):
    """A worker that forks estimators with the fake answers."""
    monkeypatch.chdir(REPOSITORY)
    environment = os.environ | {GATE: str(gate), "MAQUETTE_DATA_DIR": str(tmp_path / "data")}
    worker = SupervisedWorker(
        FAKE_WORKER,
        environment=environment,
        stop_timeout_s=PATIENCE_S,
        final_code=UNUSABLE_SETTINGS,
        on_final_end=lambda: None,
    )
    yield worker
    worker.stop()


@pytest.fixture
def lent_pool(lending_worker):
    running = EstimatorPool(by_passing_on(lending_worker.pass_on), processes=2)
    yield running
    running.stop()


def test_a_worker_forks_processes_that_answer_and_are_called_estimators(lent_pool, gate):
    assert lent_pool.body(task(with_glb=True)).glb == GLB
    pids = {answering_pid(lent_pool) for _ in range(4)}
    assert len(pids) == 2
    forked = {each.pid for each in processes_with(GATE, gate) if each.name == "estimator"}
    assert forked == pids


def test_a_lent_process_that_dies_over_a_question_or_between_is_replaced(lent_pool, monkeypatch):
    monkeypatch.setattr(processes, "RESTART_PAUSE_S", 0.0)
    before = {answering_pid(lent_pool) for _ in range(4)}
    with pytest.raises(EstimatorFailedError):
        lent_pool.body(task(segfault=1.0))
    after = {answering_pid(lent_pool) for _ in range(4)}
    assert len(before & after) == 1
    for pid in after:
        os.kill(pid, signal.SIGKILL)
    eventually(lambda: not any(is_running(pid) for pid in after), what="killed")
    assert not {answering_pid(lent_pool) for _ in range(4)} & after


def test_a_lent_process_that_takes_too_long_is_killed(lent_pool, monkeypatch):
    before = {answering_pid(lent_pool) for _ in range(4)}
    with monkeypatch.context() as impatience:
        impatience.setattr(processes, "ANSWER_WITHIN_S", 0.3)
        with pytest.raises(EstimatorTimeoutError):
            lent_pool.body(task(gate=1.0))
    after = {answering_pid(lent_pool) for _ in range(4)}
    assert len(before & after) == 1
    assert not any(is_running(pid) for pid in before - after)


def test_lent_processes_answer_while_their_worker_is_dead(lent_pool, lending_worker, gate):
    before = {answering_pid(lent_pool) for _ in range(4)}
    (worker,) = (each for each in processes_with(GATE, gate) if "fake_worker" in each.command)
    os.kill(worker.pid, signal.SIGKILL)
    eventually(lambda: not is_running(worker.pid), what="killed")
    assert {answering_pid(lent_pool) for _ in range(4)} == before


def test_a_lent_process_ends_with_its_pool(lending_worker):
    pool = EstimatorPool(by_passing_on(lending_worker.pass_on), processes=1)
    pid = answering_pid(pool)
    pool.stop()
    eventually(lambda: not is_running(pid), what="ended")


def test_what_nobody_forks_is_unavailable_until_somebody_does(lending_worker, monkeypatch):
    monkeypatch.setattr(processes, "RESTART_PAUSE_S", 0.0)
    forkers = [lambda _: None, lending_worker.pass_on]
    pool = EstimatorPool(by_passing_on(lambda given: forkers[0](given)), processes=1)
    with pytest.raises(EstimatorUnavailableError):
        pool.body(task())
    del forkers[0]
    assert pool.body(task()).estimate
    pool.stop()
