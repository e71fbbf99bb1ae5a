"""Compiled kernels: linked where nobody may write, kept after they were compiled, made anew."""

import os
import subprocess
import sys
from itertools import product
from pathlib import Path

import pytest

from service.compute import kernels
from service.compute.kernels import VARIABLE, link_kernels, settle_folders
from service.compute.worker import THREAD_LIMITS

REPOSITORY = Path(__file__).parents[3]

MADE_ANEW = """
import os, sys
from pathlib import Path

folder = Path(sys.argv[1])
sys.path.append(str(folder))
from service.compute import kernels

def fit_sample(detector):
    sys.modules.pop("_some_kernels", None)
    from _some_kernels import quadrupled
    print(quadrupled(3.0), sum(quadrupled.stats.cache_hits.values()))

kernels.fit_sample = fit_sample
kernels.make_kernels_ready()
"""

KERNELS = """
from numba import njit

@njit(cache=True)
def doubled(value):
    return 2.0 * value

@njit(cache=True)
def quadrupled(value):
    return doubled(doubled(value))
"""


def made_ready(folder: Path) -> subprocess.CompletedProcess[str]:
    """A process has its two kernels ready; it prints a result, and how many were read."""
    return subprocess.run(
        [sys.executable, "-c", MADE_ANEW, folder],
        cwd=REPOSITORY,
        env=os.environ | {"NUMBA_CACHE_DIR": str(folder / "cache")},
        capture_output=True,
        text=True,
        check=True,
    )


@pytest.mark.slow
def test_a_damaged_kernel_is_made_anew(tmp_path):
    (tmp_path / "_some_kernels.py").write_text(KERNELS)
    assert made_ready(tmp_path).stdout.split() == ["12.0", "0"]
    assert made_ready(tmp_path).stdout.split() == ["12.0", "1"]
    for damaged, left in product(("*.nbi", "*.nbc"), (0, 0.5)):
        for file in (tmp_path / "cache").rglob(damaged):
            content = file.read_bytes()
            file.write_bytes(content[: int(left * len(content))])
        mended = made_ready(tmp_path)
        assert mended.stdout.split() == ["12.0", "0"]
        assert "compiled anew" in mended.stderr
        assert made_ready(tmp_path).stdout.split() == ["12.0", "1"]


@pytest.fixture
def code(tmp_path, monkeypatch) -> Path:
    """A package with a module of kernels, one of them compiled."""
    folder = tmp_path / "package"
    (folder / "render" / "__pycache__").mkdir(parents=True)
    (folder / "render" / "_kernels.py").touch()
    (folder / "render" / "__pycache__" / "_kernels.one.nbi").write_text("kept")
    monkeypatch.setattr(kernels, "package", lambda: folder)
    return folder


def test_kernels_beside_the_code_and_those_in_another_folder_are_linked_to(code, tmp_path):
    own, kept = tmp_path / "own", tmp_path / "kept"
    link_kernels(kept)
    (next(kept.iterdir()) / "_kernels.two.nbi").write_text("new")
    link_kernels(own, kept)
    found = {file.name: file.read_text() for file in own.rglob("*.nbi") if file.is_symlink()}
    assert found == {"_kernels.one.nbi": "kept", "_kernels.two.nbi": "new"}


def test_kernels_are_compiled_once_where_there_are_none(code, monkeypatch):
    begun: list[list[str]] = []
    monkeypatch.setattr(subprocess, "run", lambda command, **_: begun.append(command))
    monkeypatch.setenv(VARIABLE, "")
    kernels.compile_once()
    assert begun == []
    (code / "render" / "__pycache__" / "_kernels.one.nbi").unlink()
    kernels.compile_once()
    assert begun == [[sys.executable, "-P", "-m", "service.compute.kernels"]]


def test_folders_are_called_as_numba_calls_them():
    from numba.core.caching import UserProvidedCacheLocator

    for folder, name in kernels._folders():
        source = str(folder / "_kernels.py")
        assert UserProvidedCacheLocator.get_suitable_cache_subpath(source) == name


@pytest.fixture
def work(tmp_path, monkeypatch) -> Path:
    monkeypatch.setattr(kernels, "make_work_folder", lambda: tmp_path / "work")
    # Put back at the end, whatever is set meanwhile; and as in a process that has not loaded Numba.
    monkeypatch.setenv(VARIABLE, os.environ.get(VARIABLE, ""))
    monkeypatch.delitem(sys.modules, "numba", raising=False)
    return tmp_path / "work"


@pytest.mark.parametrize("writable", [True, False])
def test_kernels_lie_beside_the_code_or_are_linked_to_in_the_work_folder(
    work, monkeypatch, writable
):
    monkeypatch.delenv(VARIABLE)
    monkeypatch.setattr(os, "access", lambda *_: writable)
    assert settle_folders() == work
    # Named in any case, so that no file in the current folder does.
    assert os.environ[VARIABLE] == ("" if writable else str(work / "kernels"))
    assert (work / "kernels").exists() != writable


def test_a_folder_that_is_named_stays_and_so_does_that_of_numba_once_it_is_loaded(
    work, monkeypatch
):
    monkeypatch.setattr(os, "access", lambda *_: False)
    for named, loaded in (("/elsewhere", False), ("", True)):
        monkeypatch.setenv(VARIABLE, named)
        if loaded:
            monkeypatch.setitem(sys.modules, "numba", sys)
        settle_folders()
        assert os.environ[VARIABLE] == named


@pytest.mark.slow
def test_the_fork_server_has_no_threads_and_compiles_nothing_that_is_kept():
    program = (
        "import os\n"
        "from service.compute.preload import OWN\n"
        "compiled = [file for file in OWN.rglob('*.nb[ci]') if not file.is_symlink()]\n"
        "print(len(os.listdir('/proc/self/task')), len(compiled))\n"
    )
    done = subprocess.run(
        [sys.executable, "-c", program],
        cwd=REPOSITORY,
        env=os.environ | dict.fromkeys(THREAD_LIMITS, "1"),
        capture_output=True,
        text=True,
        check=True,
    )
    assert done.stdout.split() == ["1", "0"]
