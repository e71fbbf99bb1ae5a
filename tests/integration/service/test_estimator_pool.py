"""Estimator processes: asked by many, killed, stuck, replaced, and gone with their API."""

import os
import signal
import subprocess
import sys
import threading
import time

import pytest

from api_schemas.bodies import BodyRequest
from api_schemas.requests import Gender
from service.estimates import pool as pools
from service.estimates import process as processes
from service.estimates.messages import BodyTask
from service.estimates.pool import EstimatorPool
from service.estimates.port import EstimatorFailedError, EstimatorUnavailableError
from service.refusal import RefusedError
from tests.integration.service.fake_answers import GLB
from tests.integration.service.harness import REPOSITORY, eventually, is_running

COMMAND = (sys.executable, "-m", "tests.integration.service.fake_estimator")


def task(*, with_glb: bool = False, **script: float) -> BodyTask:
    request = BodyRequest(gender=Gender.MALE, measurements=dict(script))
    return BodyTask(request=request, with_glb=with_glb)


@pytest.fixture(autouse=True)
def patience(monkeypatch):
    monkeypatch.setattr(processes, "READY_WITHIN_S", 30.0)


@pytest.fixture
def pool(monkeypatch):
    monkeypatch.chdir(REPOSITORY)
    running = EstimatorPool(COMMAND, environment=os.environ, processes=2)
    yield running
    running.stop()


def answering_pid(pool: EstimatorPool, **script: float) -> int:
    return int(pool.body(task(**script)).estimate.measurements[0].standard_error)


def test_an_answer_comes_with_its_file_where_it_is_asked_for(pool):
    assert pool.body(task(with_glb=True)).glb == GLB
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
    monkeypatch.setattr(processes, "ANSWER_WITHIN_S", 0.3)
    monkeypatch.setattr(processes, "RESTART_PAUSE_S", 0.0)
    before = {answering_pid(pool) for _ in range(4)}
    with pytest.raises(EstimatorFailedError):
        pool.body(task(sleep=60.0))
    monkeypatch.undo()
    monkeypatch.setattr(processes, "READY_WITHIN_S", 30.0)
    after = {answering_pid(pool) for _ in range(4)}
    assert len(before & after) == 1
    assert not any(is_running(pid) for pid in before - after)


def test_as_many_are_answered_at_once_as_there_are_processes_and_too_many_are_turned_away(
    pool, monkeypatch
):
    answered: list[int] = []
    refused: list[bool] = []

    def ask() -> None:
        try:
            answered.append(answering_pid(pool, sleep=0.2))
        except EstimatorUnavailableError:
            refused.append(True)

    answering_pid(pool)
    callers = [threading.Thread(target=ask) for _ in range(2 * (1 + pools.MOST_WAITING) + 5)]
    for caller in callers:
        caller.start()
    for caller in callers:
        caller.join()
    assert len(refused) == 5
    assert len(set(answered)) == 2


def test_processes_that_cannot_start_say_so_quickly(monkeypatch):
    monkeypatch.chdir(REPOSITORY)
    broken = EstimatorPool(
        (sys.executable, "-c", "import sys; sys.exit(1)"), environment={}, processes=1
    )
    started = time.monotonic()
    with pytest.raises(EstimatorUnavailableError):
        broken.body(task())
    assert time.monotonic() - started < 5.0
    broken.stop()


def test_estimators_do_not_outlive_their_api():
    program = f"""
import os, time
from service.estimates.pool import EstimatorPool
pool = EstimatorPool({COMMAND!r}, environment=os.environ, processes=2)
print(*(each._process.pid for each in pool._processes), flush=True)
time.sleep(60)
"""
    api = subprocess.Popen(
        [sys.executable, "-c", program], cwd=REPOSITORY, stdout=subprocess.PIPE, text=True
    )
    assert api.stdout is not None
    pids = [int(pid) for pid in api.stdout.readline().split()]
    api.kill()
    api.wait()
    api.stdout.close()
    eventually(lambda: not any(is_running(pid) for pid in pids), what="the estimators ended")
