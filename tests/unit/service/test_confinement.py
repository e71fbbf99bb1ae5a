"""What a process gives up before it decodes pictures."""

import json
import os
import platform
import subprocess
import sys
from pathlib import Path

import pytest

from service.process import confinement
from service.process.confinement import without_secrets
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
import ctypes, json, os, signal, socket, sys
from pathlib import Path
from service.process.confinement import confine, readable_paths
from service.settings import Settings

own, other = Path(sys.argv[1]), Path(sys.argv[2])
(other / "maquette.sqlite").write_text("before")
opened = (other / "open").open("w")
listener = socket.create_server(("127.0.0.1", 0))
address, tcp = listener.getsockname(), socket.socket()
parent, libc = os.getppid(), ctypes.CDLL(None, use_errno=True)
confined = confine(readable=readable_paths(Settings(data_dir=other)), writable=str(own))

def refused(work):
    try:
        work()
    except PermissionError:
        return True
    return False

def called(*arguments):
    if libc.syscall(*arguments) < 0:
        raise OSError(ctypes.get_errno(), "")

MPTCP, PTRACE, ATTACH, READ_OF_OTHERS, RING = 262, 101, 16, 310, 425
WAYS = {
    "TCP": lambda: socket.socket(),
    "MPTCP": lambda: socket.socket(proto=MPTCP),
    "a socket made before": lambda: tcp.connect(address),
    "MSG_FASTOPEN": lambda: tcp.sendto(b"x", socket.MSG_FASTOPEN, address),
    "UDP": lambda: socket.socket(type=socket.SOCK_DGRAM),
    "Unix sockets": lambda: socket.socket(socket.AF_UNIX),
    "pairs": lambda: socket.socketpair(),
    "a ring": lambda: called(RING, 8, ctypes.create_string_buffer(200)),
    "reading the database": lambda: (other / "maquette.sqlite").read_text(),
    "listing blobs": lambda: list(other.iterdir()),
    "reading another's secrets": lambda: Path(f"/proc/{parent}/environ").read_bytes(),
    "writing elsewhere": lambda: (other / "new").write_text("new"),
    "overwriting": lambda: (other / "maquette.sqlite").write_text("after"),
    "removing": lambda: (other / "maquette.sqlite").unlink(),
    "moving": lambda: (own / "folder").rename(other / "moved"),
    "writing to /proc": lambda: Path("/proc/self/comm").write_text("x"),
    "a signal to the parent": lambda: os.kill(parent, signal.SIGCONT),
    "a signal to all": lambda: os.kill(-1, signal.SIGCONT),
    "a thread's signal": lambda: called(234, parent, parent, signal.SIGCONT),
    "tracing": lambda: called(PTRACE, ATTACH, parent, 0, 0),
    "reading memory": lambda: called(READ_OF_OTHERS, parent, 0, 0, 0, 0, 0),
}

def import_lazily():
    import scipy.special, fitter.errors

own_works = {
    name: not refused(work)
    for name, work in {
        "write": lambda: (own / "new").write_text("new"), "unlink": lambda: (own / "new").unlink(),
        "folder": lambda: (own / "folder").mkdir(),
        "null": lambda: Path("/dev/null").write_text("x"),
        "opened": lambda: opened.write("x"), "import": import_lazily,
        "own signal": lambda: os.kill(os.getpid(), 0),
    }.items()
}
ways = {name: refused(work) for name, work in WAYS.items()}
print(json.dumps([confined, [name for name in ways if not ways[name]],
                  [name for name in own_works if not own_works[name]]]))
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


@pytest.mark.skipif(sys.platform != "linux" or platform.machine() != "x86_64", reason="numbers")
def test_no_way_leads_out_of_a_confined_process(tmp_path):
    own, other = tmp_path / "own", tmp_path / "other"
    own.mkdir()
    other.mkdir()
    confined, open_ways, broken = ran(CONFINED, own, other)
    assert confined
    assert open_ways == []
    assert broken == []
    assert (other / "maquette.sqlite").read_text() == "before"


def test_where_the_kernel_offers_nothing_the_process_goes_on_and_a_worker_warns(
    monkeypatch, tmp_path, caplog
):
    monkeypatch.setattr(confinement, "CREATE_RULESET", 100_000)
    monkeypatch.setattr(confinement, "gain_no_privileges", lambda: None)
    monkeypatch.setattr(confinement, "_restrict_calls", lambda: None)
    assert not confinement.confine(readable=[], writable=str(tmp_path))
    for user in (0, 1_000):
        caplog.clear()
        monkeypatch.setattr(os, "geteuid", lambda user=user: user)
        confinement.warn_of_weakness()
        assert "no Landlock" in caplog.text
        assert ("as root" in caplog.text) == (user == 0)


@pytest.mark.parametrize("machine", ["x86_64", "aarch64"])
def test_the_filter_refuses_what_it_names_and_signals_to_others(machine: str):
    program = confinement._filter(machine, own=41)

    def answered(number: int, argument: int = 0, architecture: str = machine) -> int:
        data = {0: number, 4: confinement.ARCHITECTURES[architecture], 16: argument}
        at, word = 0, 0
        while True:
            code, if_true, if_false, constant = program[at]
            if code == confinement.RETURN:
                return constant
            if code == confinement.LOAD:
                word = data[constant]
                at += 1
                continue
            holds = word == constant if code == confinement.EQUAL else word >= constant
            at += 1 + (if_true if holds else if_false)

    refuse, allow = confinement.REFUSE, confinement.ALLOW
    denied = (*confinement.DENIED[machine], *confinement.DENIED_EVERYWHERE)
    assert {answered(number) for number in denied} == {refuse}
    for number in confinement.SIGNALS[machine]:
        assert (answered(number, 41), answered(number, 40)) == (allow, refuse)
    others = {number for number in range(460) if number not in denied}
    assert {answered(number, 41) for number in others} == {allow}
    assert answered(1 | confinement.FOREIGN_CALLS) == refuse
    other = next(each for each in confinement.ARCHITECTURES if each != machine)
    assert answered(1, architecture=other) == refuse
