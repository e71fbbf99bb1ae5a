"""Systems that Maquette runs on: `make` names them before it installs anything."""

import runpy
import shutil
import subprocess
from pathlib import Path

import pytest

REPOSITORY = Path(__file__).parents[2]
SYSTEM = runpy.run_path(str(REPOSITORY / ".ci" / "system.py"))
ELSEWHERE = f"Maquette runs on {SYSTEM['SYSTEMS']}. Elsewhere run its image: docker/Dockerfile."


@pytest.mark.parametrize(
    ("system", "machine", "libc", "python", "fault"),
    [
        ("Linux", "x86_64", "glibc", (3, 11), None),
        ("Linux", "aarch64", "glibc", (3, 14), None),
        ("Linux", "x86_64", "", (3, 12), ELSEWHERE),
        ("Linux", "riscv64", "glibc", (3, 12), ELSEWHERE),
        ("Darwin", "x86_64", "", (3, 12), ELSEWHERE),
        ("Darwin", "arm64", "", (3, 9), ELSEWHERE),
        ("Windows", "AMD64", "", (3, 12), ELSEWHERE),
        (
            "Linux",
            "x86_64",
            "glibc",
            (3, 10),
            "Maquette needs Python 3.11 or newer: make PYTHON=...",
        ),
    ],
)
def test_systems_that_it_does_not_run_on_are_told_apart(system, machine, libc, python, fault):
    assert SYSTEM["fault"](system, machine, libc, python) == fault


def test_make_ends_with_the_sentence_and_installs_nothing(tmp_path: Path):
    """On another system: a Python that says it is on one."""
    for name in ("Makefile", "pyproject.toml", "requirements.lock", "requirements-detector.txt"):
        shutil.copy(REPOSITORY / name, tmp_path)
    (tmp_path / "service").mkdir()
    shutil.copy(REPOSITORY / "service" / "version.py", tmp_path / "service")
    (tmp_path / ".ci").mkdir()
    script = (REPOSITORY / ".ci" / "system.py").read_text()
    (tmp_path / ".ci" / "system.py").write_text(script.replace("platform.system()", "'Darwin'"))
    done = subprocess.run(
        ["make", "setup"], cwd=tmp_path, capture_output=True, text=True, check=False
    )
    assert done.returncode != 0
    assert ELSEWHERE in done.stderr
    assert not (tmp_path / ".venv").exists()
