"""What cannot be used as it is set up ends every command at once, with one line and status 78."""

import os
import re
import shutil
import socket
import subprocess
import sys
import threading
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

import psycopg
import pytest

import fitter.body
from service.cli import main
from tests.integration.service.harness import QUICK, Machine, eventually
from tests.object_storage import variable
from tests.postgres import SERVER, administration
from tests.process_table import processes_with

MODELS = Path(fitter.body.__path__[0]) / "data"
REFUSED = 78
SECRET = "opensesame"

SERVE = ("-m", "service.cli", "serve")
WORKER = ("-m", "service.cli", "worker")
CHILD_WORKER = ("-m", "service.compute", "ADDRESS")
KEYS = ("-m", "service.cli", "keys", "list")
HEALTH = ("-m", "service.cli", "health")
ESTIMATORS = ("-m", "service.compute", "questions", "ADDRESS")

ListKeys = Callable[[str], tuple[int, str]]
"""From a database's address to the exit status and the line that is told."""

WITHIN_S = 100.0
"""Far below the two minutes a database that is away is waited for."""


def run(
    arguments: Sequence[str], folder: Path, **variables: object
) -> subprocess.CompletedProcess[str]:
    machine = Machine(folder, settings={"port": 0})
    at = {"ADDRESS": str(folder.parent / "questions")}
    named = dict(map(variable, variables.items()))
    done = subprocess.run(
        [sys.executable, *(at.get(each, each) for each in arguments)],
        env=machine.environment() | named,
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
        timeout=WITHIN_S,
        check=False,
    )
    assert not processes_with("MAQUETTE_DATA_DIR", named.get("MAQUETTE_DATA_DIR", folder))
    return done


def assert_refused(done: subprocess.CompletedProcess[str], *, naming: str) -> str:
    assert done.returncode == REFUSED, done.stdout + done.stderr
    (line,) = done.stderr.splitlines()
    assert line.startswith("maquette ")
    assert naming in line
    assert SECRET not in line
    assert done.stdout == ""
    return line


@pytest.fixture(scope="module", autouse=True)
def _postgres_answers() -> None:
    try:
        administration().close()
    except psycopg.OperationalError as error:
        pytest.skip(f"no Postgres answers at 127.0.0.1:5432 ({error})")


@pytest.fixture
def list_keys(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> ListKeys:
    """Have keys listed of a database that cannot be used, by this process."""
    for name, value in QUICK.items():
        monkeypatch.setenv(f"MAQUETTE_{name.upper()}", str(value))
    monkeypatch.setenv("MAQUETTE_DATA_DIR", str(tmp_path))

    def list_keys(url: str) -> tuple[int, str]:
        monkeypatch.setenv("MAQUETTE_DATABASE_URL", url)
        with pytest.raises(SystemExit) as ended:
            main(["keys", "list"])
        (line,) = capsys.readouterr().err.splitlines()
        assert SECRET not in line
        return ended.value.code, line

    return list_keys


@pytest.mark.parametrize("command", [SERVE, WORKER, CHILD_WORKER, KEYS, HEALTH, ESTIMATORS])
def test_no_command_begins_with_an_endless_time(command: Sequence[str], tmp_path: Path):
    done = run(command, tmp_path / "data", retention_hours="inf")
    assert_refused(done, naming="MAQUETTE_RETENTION_HOURS=inf: Input should be a finite number")
    assert not (tmp_path / "data").exists()


def test_a_data_folder_below_a_file_is_refused(tmp_path: Path):
    (tmp_path / "file").touch()
    folder = tmp_path / "file" / "data"
    assert_refused(run(SERVE, tmp_path, data_dir=folder), naming=f"MAQUETTE_DATA_DIR={folder}:")


def test_a_database_that_does_not_exist_is_refused(tmp_path: Path):
    url = f"postgres://postgres:{SECRET}@127.0.0.1:5432/maquette_nowhere"
    line = assert_refused(
        run(WORKER, tmp_path, database_url=url),
        naming="MAQUETTE_DATABASE_URL=postgresql://postgres:***@127.0.0.1:5432/maquette_nowhere:",
    )
    assert 'database "maquette_nowhere" does not exist' in line


@pytest.mark.parametrize(
    ("url", "told"),
    [
        (f"mysql://user:{SECRET}@127.0.0.1/name", "URL scheme should be"),
        (f"postgresql://nobody_here:{SECRET}@127.0.0.1:5432/postgres", "does not exist"),
        (f"{SERVER}/postgres?sslmode=require", "SSL"),
        (f"{SERVER}/postgres?no_such_option=1", "no_such_option"),
    ],
)
def test_an_address_that_no_waiting_makes_right_is_refused(
    list_keys: ListKeys, url: str, told: str
):
    status, line = list_keys(url)
    assert status == REFUSED
    assert "MAQUETTE_DATABASE_URL=" in line
    assert told in line


def test_a_wrong_password_is_refused(list_keys: ListKeys):
    words = 'password authentication failed for user "maquette"'
    with server_that_refuses("28P01", words) as port:
        status, line = list_keys(f"postgresql://maquette:{SECRET}@127.0.0.1:{port}/maquette")
    assert status == REFUSED
    assert "MAQUETTE_DATABASE_URL=" in line
    assert words in line


def test_a_server_that_is_starting_up_is_waited_for(tmp_path: Path):
    with server_that_refuses("57P03", "the database system is starting up") as port:
        url = f"postgresql://maquette@127.0.0.1:{port}/maquette"
        machine = Machine(tmp_path, database_url=url)
        process = subprocess.Popen(
            [sys.executable, *SERVE], env=machine.environment(), stderr=subprocess.PIPE, text=True
        )
        try:
            assert process.stderr is not None
            assert "waiting" in process.stderr.readline()
            assert "waiting" in process.stderr.readline()
            assert process.poll() is None
        finally:
            process.kill()
            process.communicate()


def test_a_database_that_does_not_come_is_given_up_with_another_status(
    list_keys: ListKeys, monkeypatch: pytest.MonkeyPatch
):
    monkeypatch.setattr("service.process.retrying.RETRY_FOR_S", 0.0)
    status, line = list_keys(f"postgresql://user:{SECRET}@127.0.0.1:9/none")
    assert status == os.EX_UNAVAILABLE
    assert "the database is not available" in line


def test_a_damaged_body_model_is_refused(tmp_path: Path):
    shutil.copytree(MODELS, tmp_path / "models")
    damaged = tmp_path / "models" / "male.npz"
    damaged.write_bytes(damaged.read_bytes()[:-100_000])
    done = run(CHILD_WORKER, tmp_path / "data", models_dir=damaged.parent)
    line = assert_refused(done, naming=f"MAQUETTE_MODELS_DIR={damaged.parent}:")
    assert "male.npz" in line


def test_a_folder_without_the_detector_s_weights_is_refused(tmp_path: Path):
    (tmp_path / "detector").mkdir()
    done = run(SERVE, tmp_path / "data", detector_dir=tmp_path / "detector")
    line = assert_refused(done, naming=f"MAQUETTE_DETECTOR_DIR={tmp_path / 'detector'}:")
    assert "pose_detection.tflite" in line


def test_a_folder_of_another_user_is_refused(tmp_path: Path):
    if os.geteuid() != 0:
        pytest.skip("only root can become somebody else")
    tmp_path.chmod(0o755)
    folder = tmp_path / "data"
    folder.mkdir(mode=0o755)
    becoming_nobody = (
        "import os, pwd, sys\n"
        "from service.commands.serve import preflight\n"
        "from service.startup import run_service\n"
        "import service.jobs.records, sqlalchemy.exc\n"
        "def work(settings):\n"
        "    os.setgroups([]), os.setgid(65534), os.setuid(65534)\n"
        "    preflight(settings)\n"
        "sys.exit(run_service('serve', work))\n"
    )
    line = assert_refused(run(("-c", becoming_nobody), folder), naming=f"{folder}")
    assert "MAQUETTE_DATA_DIR=" in line
    assert "own" in line


def test_a_worker_that_cannot_run_as_set_up_stops_the_service(tmp_path: Path):
    """Models that are damaged under a running service: its next worker says so, once."""
    models = tmp_path / "models"
    shutil.copytree(MODELS, models)
    machine = Machine(tmp_path / "data", settings={"models_dir": models})
    process = subprocess.Popen(
        [sys.executable, *SERVE],
        env=machine.environment(),
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    try:
        assert process.stdout is not None
        assert "listens" in process.stdout.readline()
        (models / "male.npz").write_bytes(b"damaged")
        workers = eventually(
            lambda: [
                each
                for each in processes_with("MAQUETTE_DATA_DIR", machine.data_dir)
                if "service.compute" in each.command and each.parent == process.pid
            ],
            what="a worker runs",
        )
        for each in workers:
            os.kill(each.pid, 9)
        _, said = process.communicate(timeout=WITHIN_S)
    finally:
        process.kill()
        process.wait()
    assert process.returncode == REFUSED, said
    told = [line for line in said.splitlines() if line.startswith("maquette worker: ")]
    assert len(told) == 1
    assert "male.npz" in told[0]
    eventually(lambda: not processes_with("MAQUETTE_DATA_DIR", machine.data_dir))


def test_an_unknown_name_is_warned_of_once_and_refused_nowhere(tmp_path: Path):
    done = run(KEYS, tmp_path / "data", retention_huors=1)
    assert done.returncode == 0, done.stderr
    assert re.findall(r"MAQUETTE_RETENTION_\w+", done.stderr) == ["MAQUETTE_RETENTION_HUORS"]


@contextmanager
def server_that_refuses(sqlstate: str, words: str) -> Iterator[int]:
    """A server that answers every connection as Postgres refuses one."""
    fields = {"S": "FATAL", "V": "FATAL", "C": sqlstate, "M": words}
    body = b"".join(f"{kind}{text}".encode() + b"\0" for kind, text in fields.items()) + b"\0"
    answer = b"E" + (len(body) + 4).to_bytes(4, "big") + body

    def refuse(listener: socket.socket) -> None:
        while True:
            try:
                connection, _ = listener.accept()
            except OSError:
                return
            with connection:
                asked = connection.recv(8)
                if asked[4:] == b"\x04\xd2\x16\x2f":  # for encryption
                    connection.sendall(b"N")
                connection.recv(8_192)
                connection.sendall(answer)

    with socket.create_server(("127.0.0.1", 0)) as listener:
        threading.Thread(target=refuse, args=(listener,), daemon=True).start()
        yield listener.getsockname()[1]
        listener.shutdown(socket.SHUT_RDWR)
