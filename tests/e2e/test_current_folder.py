"""A service runs nothing that lies in the folder it is started in."""

import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from service.demo_data.sample import load_sample
from service.process.supervisor import PYTHON
from tests.e2e.service import FIT_WITHIN_S, started_service, wait_for_estimator

MAQUETTE = Path(sys.executable).with_name("maquette")
NAMES = ("fitter", "http", "json", "logging", "numpy", "selectors", "service", "signal", "socket")
"""Modules that processes of ours import, of ours, of others and of Python."""

STOPPED_WITHIN_S = 60.0

LEAVES_A_MARK = """
from pathlib import Path
with Path({mark!r}).open("a") as mark:
    print(__file__, file=mark)
"""
LISTS_ITSELF = """
import sys
with open({processes!r}, "a") as processes:
    print(*sys.orig_argv, file=processes)
"""

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(not MAQUETTE.exists(), reason="maquette is not installed: run `make test`"),
]


class Folder:
    """A folder full of modules, of which each leaves a mark when it is run.

    Every process started with its ``environment`` adds its command to ``processes``, by a module on
    PYTHONPATH.
    """

    def __init__(self, place: Path) -> None:
        self.path = place / "current"
        self.path.mkdir()
        self.mark = place / "mark"
        for name in NAMES:
            (self.path / f"{name}.py").write_text(LEAVES_A_MARK.format(mark=str(self.mark)))
        # Numba would read where it finds compiled code, and run it.
        (self.path / ".numba_config.yaml").write_text("cache_dir: kernels\n")
        self.processes = place / "processes"
        chosen = place / "chosen"
        chosen.mkdir()
        (chosen / "sitecustomize.py").write_text(LISTS_ITSELF.format(processes=str(self.processes)))
        path = [str(chosen), *filter(None, [os.environ.get("PYTHONPATH")])]
        inherited = {name: value for name, value in os.environ.items() if "MAQUETTE_" not in name}
        self.environment = inherited | {"PYTHONPATH": os.pathsep.join(path)}

    def left(self) -> list[str]:
        """The files in it that were not there at first."""
        return sorted(
            path.name for path in self.path.iterdir() if path.suffix not in {".py", ".yaml"}
        )


@pytest.fixture
def folder(tmp_path: Path) -> Folder:
    return Folder(tmp_path)


def test_the_folders_modules_are_run_where_they_are_looked_for(folder: Folder):
    command = [sys.executable, "-m", "json.tool", "--help"]
    subprocess.run(command, cwd=folder.path, capture_output=True, check=False)
    assert folder.mark.exists()


def test_neither_api_nor_worker_nor_their_forks_run_what_lies_there(folder: Folder):
    done = subprocess.run(
        [MAQUETTE, "demo", "--output", "demo-output"],
        cwd=folder.path,
        env=folder.environment,
        capture_output=True,
        text=True,
        timeout=FIT_WITHIN_S,
        check=False,
    )
    assert not folder.mark.exists(), folder.mark.read_text()
    assert done.returncode == 0, done.stdout + done.stderr
    assert folder.left() == ["demo-output"]
    started = folder.processes.read_text()
    for process in (
        f"{MAQUETTE} demo",
        "-m service.cli serve",
        "-m service.compute",
        "multiprocessing.forkserver",
        "multiprocessing.resource_tracker",
    ):
        assert process in started


@pytest.mark.parametrize("command", [[MAQUETTE], [*PYTHON, "-m", "service.cli"]])
def test_a_worker_of_its_own_and_its_fork_server_run_nothing_either(folder: Folder, command):
    with subprocess.Popen(
        [*command, "worker"],
        cwd=folder.path,
        env=folder.environment,
        stderr=subprocess.PIPE,
        text=True,
    ) as worker:
        assert worker.stderr is not None
        try:
            said = [next((line for line in worker.stderr if "is ready" in line), None)]
        finally:
            worker.send_signal(signal.SIGTERM)
            worker.communicate(timeout=STOPPED_WITHIN_S)
    assert not folder.mark.exists(), folder.mark.read_text()
    assert said != [None]
    assert folder.left() == ["maquette-data"]
    assert "multiprocessing.forkserver" in folder.processes.read_text()


def test_an_api_alone_and_its_estimator_run_nothing_either(folder: Folder):
    command = [str(MAQUETTE), "serve", "--no-worker", "--port", "0"]
    with started_service(command, cwd=folder.path, environment=folder.environment) as client:
        wait_for_estimator(client)
        image = {"image": ("sample.jpg", load_sample().image, "image/jpeg")}
        answer = client.post("/v1/points", files=image)
    assert not folder.mark.exists(), folder.mark.read_text()
    assert answer.status_code == 200, answer.text
    assert folder.left() == ["maquette-data"]
    assert "-m service.compute questions" in folder.processes.read_text()
