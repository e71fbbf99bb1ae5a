"""A process' own folder for temporary files."""

import fcntl
import os
import signal
import stat
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path

import pytest

from service.process.work_folder import LOCK, PREFIX, YOUNG_S, remove_abandoned

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
