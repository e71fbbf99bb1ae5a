"""Processes: work folders, connections, logs, and the signal that ends them."""

import contextlib
import fcntl
import json
import os
import resource
import signal
import socket
import stat
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path

import pytest

from service.process.listener import KEPT_DESCRIPTORS, Listener, connection_limit, listen
from service.process.work_folder import LOCK, PREFIX, YOUNG_S, remove_abandoned
from service.settings import Settings

REPOSITORY = Path(__file__).parents[3]

PROGRAM = """
import os, sys, tempfile
from multiprocessing import forkserver
from service.process.work_folder import make_work_folder

folder = make_work_folder()
assert make_work_folder() == folder
assert tempfile.gettempdir() == os.environ["TMPDIR"] == str(folder)
forkserver.ensure_running()
print(folder, flush=True)
sys.stdin.read()
"""


@pytest.fixture
def short() -> Iterator[Path]:
    """A folder whose path leaves room for that of a socket."""
    with tempfile.TemporaryDirectory() as folder:
        yield Path(folder)


def started(parent: Path) -> tuple[subprocess.Popen[str], Path]:
    process = subprocess.Popen(
        [sys.executable, "-c", PROGRAM],
        cwd=REPOSITORY,
        env=os.environ | {"TMPDIR": str(parent)},
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
    )
    assert process.stdout is not None
    return process, Path(process.stdout.readline().strip())


def aged(folder: Path) -> None:
    seen = folder.stat().st_mtime - 2.0 * YOUNG_S
    os.utime(folder, (seen, seen))


def test_it_is_private_holds_what_the_fork_server_leaves_and_goes_with_the_process(short):
    process, folder = started(short)
    assert stat.S_IMODE(folder.stat().st_mode) == 0o700
    assert list(folder.glob("pymp-*"))
    process.communicate()
    assert process.returncode == 0
    assert list(short.iterdir()) == []


def test_that_of_a_killed_process_is_removed_by_the_next_and_that_of_a_live_one_is_not(short):
    living, lived_in = started(short)
    killed, left = started(short)
    killed.send_signal(signal.SIGKILL)
    killed.communicate()
    aged(lived_in)
    aged(left)
    remove_abandoned(short)
    assert lived_in.exists()
    assert not left.exists()
    living.communicate()


def test_a_folder_that_has_just_been_made_is_left_alone(short):
    young = short / f"{PREFIX}{os.geteuid()}-young"
    young.mkdir()
    remove_abandoned(short)
    assert young.exists()


@pytest.mark.parametrize("name", ["pymp-other", f"{PREFIX}{os.geteuid() + 1}-other"])
def test_folders_of_others_are_left_alone(short, name):
    (short / name).mkdir()
    aged(short / name)
    remove_abandoned(short)
    assert (short / name).exists()


def test_a_folder_whose_lock_is_held_is_left_alone(short):
    folder = short / f"{PREFIX}{os.geteuid()}-held"
    folder.mkdir()
    with (folder / LOCK).open("w") as held:
        fcntl.flock(held, fcntl.LOCK_EX)
        aged(folder)
        remove_abandoned(short)
    assert folder.exists()


def test_a_fork_server_that_outlived_its_worker_loads_nothing(short):
    program = "import service.compute.preload; print('loaded')"
    (short / LOCK).touch()
    variables = {"TMPDIR": str(short), "NUMBA_CACHE_DIR": os.environ.get("NUMBA_CACHE_DIR", "")}
    done = subprocess.run(
        [sys.executable, "-c", program],
        cwd=REPOSITORY,
        env=os.environ | variables,
        stdout=subprocess.PIPE,
        check=True,
    )
    assert done.stdout == b""


MOST = 5


@pytest.fixture
def listener(monkeypatch: pytest.MonkeyPatch) -> Iterator[Listener]:
    monkeypatch.setattr("service.process.listener.LOOK_S", 0.0)
    with Listener(socket.AF_INET, most=MOST) as listener:
        listener.bind(("127.0.0.1", 0))
        listener.listen()
        yield listener


def connect(listener: Listener) -> socket.socket:
    return socket.create_connection(listener.getsockname(), timeout=10.0)


def test_too_many_connections_are_turned_away_until_others_close_and_told_once(listener, caplog):
    with contextlib.ExitStack() as stack:
        for _ in range(MOST):
            stack.enter_context(connect(listener)).sendall(b"GET / HT")
        served = [listener.accept()[0] for _ in range(MOST)]
        for _ in range(20):
            with connect(listener) as another:
                with pytest.raises(ConnectionAbortedError):
                    listener.accept()
                assert another.recv(1) == b""
        served.pop().close()
        stack.enter_context(connect(listener))
        served.append(listener.accept()[0])
        for each in served:
            each.close()
    assert [record.getMessage() for record in caplog.records] == [
        "5 connections are open: more are turned away."
    ]


@pytest.mark.parametrize(
    ("descriptors", "limit"), [(100, 50), (1_024, 1_024 - KEPT_DESCRIPTORS), (1_048_576, 10_000)]
)
def test_connections_leave_descriptors_for_everything_else(descriptors: int, limit: int):
    assert connection_limit(descriptors) == limit


def test_listening_raises_the_soft_limit_of_descriptors_to_the_hard_one():
    soft, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    resource.setrlimit(resource.RLIMIT_NOFILE, (min(soft, 512), hard))
    try:
        listen(Settings(port=0)).close()
        assert resource.getrlimit(resource.RLIMIT_NOFILE) == (hard, hard)
    finally:
        resource.setrlimit(resource.RLIMIT_NOFILE, (soft, hard))


COMPILES = """
import logging
from service.process.logs import configure_logging

configure_logging("{level}")
import numba

logging.getLogger("service.something").debug("ours at DEBUG")
logging.getLogger("asyncio").debug("theirs at DEBUG")
logging.getLogger("asyncio").info("theirs at INFO")
assert numba.njit(lambda number: number + 1)(1) == 2
"""


def said_at(level: str) -> str:
    program = COMPILES.format(level=level)
    return subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, check=True
    ).stderr


def test_at_debug_we_tell_more_and_the_libraries_do_not():
    said = said_at("DEBUG")
    assert "ours at DEBUG" in said
    assert "theirs at INFO" in said
    assert "theirs at DEBUG" not in said
    assert "numba" not in said


def test_a_higher_level_holds_for_all():
    assert "ours" not in said_at("INFO")
    assert said_at("WARNING") == ""


DBOS_IN_AN_OUTAGE = """
from service.process.logs import configure_logging

configure_logging("INFO", "json")
import dbos
import logging
from sqlalchemy.exc import OperationalError

away = OperationalError("SELECT", {}, Exception("connection refused"))
try:
    raise away
except OperationalError:
    import traceback
    logging.getLogger("dbos").warning(f"Exception polling: {traceback.format_exc()}")
logging.getLogger("dbos").warning(f"Exception listing: {away}")
logging.getLogger("dbos").error("A fault:\\nwith its frames")
"""


def test_dbos_logs_as_we_do_and_an_outage_in_one_line():
    said = subprocess.run(
        [sys.executable, "-c", DBOS_IN_AN_OUTAGE], capture_output=True, text=True, check=True
    ).stderr
    polling, listing, fault = [json.loads(line)["message"] for line in said.splitlines()]
    cause = "(builtins.Exception) connection refused"
    assert polling == f"Exception polling: sqlalchemy.exc.OperationalError: {cause}"
    assert listing.startswith("Exception listing: ")
    assert fault == "A fault:\nwith its frames"


WAITS_AND_IS_SIGNALLED = """
import signal, sys
from service.compute.worker import StopRequest

def stopped_at(step):
    # A wait during whose line number `step` a signal comes; or before which it came.
    stop = StopRequest()
    signal.signal(signal.SIGTERM, lambda *_: stop.ask())
    seen = 0
    def trace(frame, event, _):
        nonlocal seen
        if event == "line":
            seen += 1
            if seen == step:
                sys.settrace(None)
                signal.raise_signal(signal.SIGTERM)
        return trace
    if step == 0:
        signal.raise_signal(signal.SIGTERM)
    sys.settrace(trace)
    signal.setitimer(signal.ITIMER_REAL, 0.1)
    stop.wait()
    sys.settrace(None)

signal.signal(signal.SIGALRM, lambda *_: signal.raise_signal(signal.SIGTERM))
for step in range(12):
    stopped_at(step)
"""


def test_a_signal_at_any_line_of_the_wait_ends_it():
    subprocess.run([sys.executable, "-c", WAITS_AND_IS_SIGNALLED], timeout=60, check=True)


ASLEEP_BEFORE_THE_HANDLER_RUNS = """
import _thread, signal, threading
from service.compute.worker import StopRequest

stop = StopRequest()
signal.signal(signal.SIGTERM, lambda *_: stop.ask())
# Python notes the signal, and nothing wakes the main thread, which sleeps by then.
threading.Timer(0.3, lambda: _thread.interrupt_main(signal.SIGTERM)).start()
stop.wait()
"""


def test_a_signal_noted_just_before_the_wait_sleeps_ends_it():
    subprocess.run([sys.executable, "-c", ASLEEP_BEFORE_THE_HANDLER_RUNS], timeout=60, check=True)
