"""What a process gives up before it decodes pictures."""

import ctypes
import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

from service.process.confinement import (
    ASK_VERSION,
    CREATE_RULESET,
    NETWORK_SINCE,
    without_secrets,
)
from service.settings import Settings

REPOSITORY = Path(__file__).parents[3]

EXECUTED_ANEW = """
import json, os, sys
from pathlib import Path
from service.process.confinement import forget_secrets

forget_secrets()
names = Path("/proc/self/environ").read_text().split("\\0")
status = Path("/proc/self/status").read_text()
print(json.dumps([os.getpid(), sys.argv[1:], names, "NoNewPrivs:\\t1" in status]))
"""

CONFINED = """
import json, os, socket, sys
from pathlib import Path
from service.process.confinement import write_only_below

own, other = Path(sys.argv[1]), Path(sys.argv[2])
(other / "before").write_text("before")
opened = (other / "open").open("w")
confined = write_only_below(str(own))

def refused(work):
    try:
        work()
    except PermissionError:
        return True
    return False

def connect():
    try:
        socket.create_connection(("127.0.0.1", 9)).close()
    except ConnectionRefusedError:
        pass

own_works = not any(map(refused, [
    lambda: (own / "new").write_text("new"), lambda: (own / "folder").mkdir(),
    lambda: (own / "new").unlink(), lambda: (other / "before").read_text(),
    lambda: Path("/dev/null").write_text("x"), lambda: Path("/proc/self/comm").write_text("x"),
    lambda: opened.write("x"),
]))
kept_off = [refused(each) for each in (
    lambda: (other / "new").write_text("new"), lambda: (other / "folder").mkdir(),
    lambda: (other / "before").write_text("after"), lambda: (other / "before").unlink(),
    lambda: (own / "folder").rename(other / "moved"),
)]
print(json.dumps([confined, own_works, kept_off, refused(connect)]))
"""


def ran(program: str, *arguments: object, **environment: str) -> list:
    done = subprocess.run(
        [sys.executable, "-c", program, *map(str, arguments)],
        cwd=REPOSITORY,
        env=os.environ | environment,
        stdout=subprocess.PIPE,
        check=True,
    )
    return json.loads(done.stdout)


def test_a_process_is_executed_anew_with_what_it_needs_of_its_environment():
    secrets = {
        "MAQUETTE_DATABASE_URL": "postgresql://user:password@host/database",
        "MAQUETTE_WEBHOOK_SECRET": "secret",
        "AWS_SECRET_ACCESS_KEY": "secret",
        "PGPASSWORD": "secret",
    }
    told = {"MAQUETTE_MAX_PIXELS": "1000", "NUMBA_CPU_NAME": "generic", "OMP_NUM_THREADS": "1"}
    _, arguments, names, gains_nothing = ran(EXECUTED_ANEW, "one", "two", **secrets, **told)
    assert arguments == ["one", "two"]
    assert gains_nothing
    assert not [each for each in names if each.partition("=")[0] in secrets]
    assert {f"{name}={value}" for name, value in told.items()} <= set(names)


def test_no_setting_is_needed_that_may_hold_a_secret():
    every = {f"MAQUETTE_{name.upper()}": "x" for name in Settings.model_fields}
    held = ("SECRET", "URL", "KEY", "PASSWORD", "TOKEN")
    assert not [each for each in without_secrets(every) if any(word in each for word in held)]


def landlock_version() -> int:
    return ctypes.CDLL(None).syscall(CREATE_RULESET, None, ctypes.c_size_t(0), ASK_VERSION)


@pytest.mark.skipif(landlock_version() < 1, reason="the kernel has no Landlock")
def test_a_confined_process_writes_nowhere_but_in_its_folder_and_opens_no_tcp_connection(tmp_path):
    own, other = tmp_path / "own", tmp_path / "other"
    own.mkdir()
    other.mkdir()
    confined, own_works, kept_off, no_tcp = ran(CONFINED, own, other)
    assert confined
    assert own_works
    assert kept_off == [True] * 5
    assert no_tcp == (landlock_version() >= NETWORK_SINCE)
    assert (other / "before").read_text() == "before"


def test_where_the_kernel_offers_nothing_the_process_goes_on(monkeypatch, tmp_path):
    from service.process import confinement

    monkeypatch.setattr(confinement, "CREATE_RULESET", 100_000)
    monkeypatch.setattr(confinement, "gain_no_privileges", lambda: None)
    assert not confinement.write_only_below(str(tmp_path))
