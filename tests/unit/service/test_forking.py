"""Forked processes: the server behind them may die at any moment."""

import os
import signal
from multiprocessing import forkserver
from multiprocessing.connection import Connection

import pytest

from service.worker.forking import ForkedProcesses, end


@pytest.fixture(scope="module")
def processes():
    return ForkedProcesses("json")


def greet(name: str, connection: Connection) -> None:
    connection.send(f"{name} from {os.getpid()}")


def greeting(processes: ForkedProcesses) -> str:
    connection, process = processes.start(greet, "hello")
    try:
        return connection.recv()
    finally:
        end(connection, process)


def test_a_process_runs_what_it_is_told_with_its_end_of_the_pipe(processes):
    assert greeting(processes).startswith("hello from ")


def test_a_server_is_waited_for_until_it_has_loaded_its_module(processes):
    processes.begin_preloading()
    processes.wait_until_loaded()
    assert greeting(processes).startswith("hello from ")


def test_a_killed_server_is_started_again(processes):
    greeting(processes)
    server = forkserver._forkserver._forkserver_pid  # pyright: ignore
    os.kill(server, signal.SIGKILL)
    assert greeting(processes).startswith("hello from ")
    assert forkserver._forkserver._forkserver_pid != server  # pyright: ignore


@pytest.mark.parametrize("fault", [ConnectionRefusedError(), EOFError(), BlockingIOError()])
def test_a_start_that_meets_a_dying_server_is_tried_again(processes, monkeypatch, fault):
    from multiprocessing.context import ForkServerProcess

    start = ForkServerProcess.start
    faults = [fault]

    def start_at_the_second_try(process: ForkServerProcess) -> None:
        if faults:
            raise faults.pop()
        start(process)

    monkeypatch.setattr(ForkServerProcess, "start", start_at_the_second_try)
    assert greeting(processes).startswith("hello from ")
    assert faults == []
