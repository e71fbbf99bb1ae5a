"""Child processes: the server behind them may die, messages arrive whole or not at all."""

import os
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator
from multiprocessing import Pipe
from multiprocessing.connection import Connection
from pathlib import Path

import pytest
from pydantic import ValidationError

from service.compute import messages
from service.compute.fork_server import ForkServer, end
from service.compute.messages import DoneMessage, ProgressMessage, TaskMessage, receive, send
from service.jobs.records import Report

REPOSITORY = Path(__file__).parents[3]


def eventually(holds: Callable[[], bool]) -> None:
    while not holds():
        time.sleep(0.01)


@pytest.fixture(scope="module")
def processes():
    return ForkServer("json")


def greet(name: str, connection: Connection) -> None:
    connection.send(f"{name} from {os.getpid()}")


def greeting(processes: ForkServer) -> str:
    connection, process = processes.start(greet, "hello")
    try:
        return connection.recv()
    finally:
        end(connection, process)


def test_a_process_runs_what_it_is_told_with_its_end_of_the_pipe(processes):
    assert greeting(processes).startswith("hello from ")


def test_a_server_is_waited_for_until_it_has_loaded_its_module(processes):
    processes.begin_preloading()
    eventually(processes.is_able)
    assert greeting(processes).startswith("hello from ")


def server_of(processes: ForkServer) -> int:
    connection, process = processes.start(tell_server)
    try:
        return connection.recv()
    finally:
        end(connection, process)


def tell_server(connection: Connection) -> None:
    connection.send(os.getppid())


def test_a_killed_server_is_started_again(processes):
    server = server_of(processes)
    os.kill(server, signal.SIGKILL)
    assert server_of(processes) != server


DYING = """
import os, signal, sys, threading
from pathlib import Path
from service.compute import fork_server

fault = Path(sys.argv[1])
processes = fork_server.ForkServer("dies_if_told")

def tell_server(connection):
    connection.send(os.getppid())

if __name__ == "__main__":
    os.environ["PYTHON_FAULT"] = str(fault)
    fault.touch()
    processes.begin_preloading()
    for _ in range(2):
        try:
            processes.start(print)
        except fork_server.NoProcessError:
            print("none", processes.is_able())
    fault.unlink()
    able = threading.Event()
    while not processes.is_able():
        able.wait(0.01)
    print("able")
    fault.touch()
    connection, _ = processes.start(tell_server)
    os.kill(connection.recv(), signal.SIGKILL)
    try:
        processes.start(print)
    except fork_server.NoProcessError:
        print("none", processes.is_able())
"""

DIES_IF_TOLD = """
import os
if os.path.exists(os.environ["PYTHON_FAULT"]):
    os._exit(1)
"""


@pytest.mark.slow
def test_a_server_that_dies_time_after_time_is_not_waited_for_until_it_lives(tmp_path):
    (tmp_path / "dies_if_told.py").write_text(DIES_IF_TOLD)
    (tmp_path / "program.py").write_text(DYING)
    done = subprocess.run(
        [sys.executable, "program.py", str(tmp_path / "fault")],
        cwd=tmp_path,
        env=os.environ | {"PYTHONPATH": f"{REPOSITORY}{os.pathsep}{tmp_path}"},
        stdout=subprocess.PIPE,
        text=True,
        check=True,
    )
    assert done.stdout.splitlines() == ["none False", "none False", "able", "none False"]


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


Ends = tuple[Connection, Connection]


@pytest.fixture
def ends() -> Iterator[Ends]:
    ours, theirs = Pipe()
    with ours, theirs:
        yield ours, theirs


def test_a_message_arrives_with_its_parts_by_name(ends: Ends):
    task = TaskMessage(task="fit", parts=("image", "mask"), log_context={"job": "1"})
    send(ends[0], task, [b"picture", b""])
    received = receive(ends[1])
    assert received.message == task
    assert received.parts == {"image": b"picture", "mask": b""}


def test_messages_without_parts_follow_one_another(ends: Ends):
    report = ProgressMessage(
        report=Report(stage="shading", progress=0.5, energies={"total": 1.0}, view=1)
    )
    for message in (report, DoneMessage()):
        send(ends[0], message)
    assert [receive(ends[1]).message for _ in range(2)] == [report, DoneMessage()]


def test_each_part_is_sent_before_the_next_one_is_made(ends: Ends):
    is_there = threading.Event()

    def parts() -> Iterator[bytes]:
        yield b"first"
        assert is_there.wait(60.0)
        yield b"second"

    task = TaskMessage(task="fit", parts=("a", "b"))
    sending = threading.Thread(target=send, args=(ends[0], task, parts()))
    sending.start()
    assert b"fit" in ends[1].recv_bytes()
    assert ends[1].recv_bytes() == b"first"
    is_there.set()
    assert ends[1].recv_bytes() == b"second"
    sending.join()


@pytest.mark.parametrize("sent", [b"", b"{}", b'{"kind":"greeting"}', b"\x80\x04N."])
def test_what_is_no_message_is_refused_and_never_unpickled(ends: Ends, sent: bytes):
    ends[0].send_bytes(sent)
    with pytest.raises(ValidationError):
        receive(ends[1])


def test_a_part_that_is_too_large_is_not_taken(ends: Ends, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(messages, "LARGEST_PART_BYTES", 100)
    send(ends[0], DoneMessage(parts=("file",)), [bytes(101)])
    with pytest.raises(OSError):  # noqa: PT011 - as the standard library raises it
        receive(ends[1])
