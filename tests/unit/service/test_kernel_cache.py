"""Compiled kernels in one checked file: whatever happens to it costs no more than its remaking."""

import os
import shutil
import subprocess
import sys
import textwrap
from pathlib import Path

import pytest

from service.worker.kernel_cache import PACKAGE, SOURCES

pytestmark = pytest.mark.slow

REPOSITORY = Path(__file__).parents[3]

KERNELS = """
from numba import njit

@njit(cache=True, inline="never")
def doubled(value):
    return 2.0 * value

@njit(cache=True)
def quadrupled(value):
    return doubled(doubled(value))
"""

PROGRAM = """
import os, sys
from pathlib import Path
import fitter

folder = Path(sys.argv[1])
fitter.__path__.append(str(folder))
from service.worker import kernel_cache

kernel_cache.PACKAGE = folder
if "--other-code" in sys.argv:
    kernel_cache.code_digest = lambda: b"other"
from service.process.caches import KERNELS, settle_folders

settle_folders()
compiled = []

def compile_all():
    from fitter._some_kernels import quadrupled
    quadrupled(1.0)
    compiled.append(os.getpid())
    (folder / "compiled").open("a").write("x")
    return "--fails" not in sys.argv

if "--command" in sys.argv:
    with kernel_cache.kept_kernels():
        from fitter._some_kernels import quadrupled
        quadrupled(1)
    sys.exit()
if "--warm-up" in sys.argv:
    with kernel_cache.kept_kernels(rehearsed=True):
        compile_all()
    sys.exit()

kernel_cache.make_kernels_ready(compile_all)
from fitter._some_kernels import quadrupled
print(quadrupled(3.0), sum(quadrupled.stats.cache_hits.values()), len(quadrupled.signatures))
"""


@pytest.fixture(scope="module")
def packed(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Path]:
    """A folder with a module of two kernels, whose cache is full, and a copy of it."""
    folder, copy = tmp_path_factory.mktemp("kernels"), tmp_path_factory.mktemp("copies") / "copy"
    (folder / "_some_kernels.py").write_text(KERNELS)
    assert ran(folder).split() == ["12.0", "1", "1"]
    assert compiled(folder) == 1
    shutil.copytree(folder, copy)
    return folder, copy


@pytest.fixture
def package(packed: tuple[Path, Path]) -> Path:
    """The folder as it was first: what is compiled is known by its path and its times."""
    folder, copy = packed
    shutil.rmtree(folder)
    shutil.copytree(copy, folder)
    return folder


def ran(package: Path, *arguments: str, tells: str = "", users: Path | None = None) -> str:
    done = subprocess.run(
        [sys.executable, "-c", textwrap.dedent(PROGRAM), str(package), *arguments],
        cwd=REPOSITORY,
        env=os.environ | {"FITTER_CACHE_DIR": str(users or ""), "PYTHONDONTWRITEBYTECODE": "1"},
        capture_output=True,
        text=True,
        check=True,
    )
    assert tells in done.stderr
    return done.stdout


def compiled(package: Path) -> int:
    return len((package / "compiled").read_text())


def kept_file(package: Path) -> Path:
    (path,) = (package / "__pycache__").glob("kernels-*")
    return path


def test_what_is_kept_is_read_and_not_compiled(package: Path):
    assert ran(package).split() == ["12.0", "1", "1"]
    assert compiled(package) == 1


def flipped(path: Path) -> None:
    content = bytearray(path.read_bytes())
    content[len(content) // 2] ^= 4
    path.write_bytes(content)


def replaced_by_a_folder(path: Path) -> None:
    path.unlink()
    path.mkdir()


def test_a_damaged_file_costs_its_remaking_and_one_line(package: Path):
    flipped(kept_file(package))
    assert ran(package, tells="are made anew").split() == ["12.0", "1", "1"]
    assert compiled(package) == 2
    assert ran(package).split() == ["12.0", "1", "1"]
    assert compiled(package) == 2


def test_a_missing_file_is_made_anew(package: Path):
    kept_file(package).unlink()
    assert ran(package).split() == ["12.0", "1", "1"]
    assert compiled(package) == 2


def test_what_was_compiled_by_a_rehearsal_that_failed_is_not_kept(package: Path):
    kept_file(package).unlink()
    ran(package, "--fails")
    assert not list((package / "__pycache__").glob("kernels-*"))


def test_what_a_command_compiled_is_kept_and_completed_once_by_a_rehearsal(package: Path):
    kept_file(package).unlink()
    ran(package, "--command")
    assert compiled(package) == 1
    assert ran(package).split() == ["12.0", "2", "2"]
    assert compiled(package) == 2
    assert ran(package).split() == ["12.0", "2", "2"]
    assert compiled(package) == 2


def test_what_a_command_adds_leaves_complete_what_was_complete(package: Path):
    ran(package, "--command")
    assert ran(package).split() == ["12.0", "2", "2"]
    assert compiled(package) == 1


def test_what_is_complete_in_the_users_cache_goes_before_less_beside_the_code(
    package: Path, tmp_path: Path
):
    shutil.move(kept_file(package), tmp_path)
    ran(package, "--command")
    assert ran(package, users=tmp_path).split() == ["12.0", "1", "1"]
    assert compiled(package) == 1


def test_after_a_warm_up_nothing_is_rehearsed(package: Path):
    kept_file(package).unlink()
    ran(package, "--command")
    ran(package, "--warm-up")
    assert compiled(package) == 2
    assert ran(package).split() == ["12.0", "2", "2"]
    assert compiled(package) == 2


def test_other_code_around_the_same_kernels_is_rehearsed_once(package: Path):
    for _ in range(2):
        assert ran(package, "--other-code").split() == ["12.0", "1", "1"]
        assert compiled(package) == 2


def test_a_command_after_a_change_of_kernels_keeps_none_of_their_old_signatures(package: Path):
    changed = KERNELS.replace("doubled(value)", "doubled(value, times)").replace("2.0", "times")
    changed = changed.replace("doubled(doubled(value, times))", "doubled(doubled(value, 2.0), 2.0)")
    (package / "_some_kernels.py").write_text(changed)
    ran(package, "--command")
    assert ran(package).split() == ["12.0", "2", "2"]


def test_where_nothing_can_be_read_or_kept_everything_is_compiled(package: Path):
    replaced_by_a_folder(kept_file(package))
    assert ran(package, tells="cannot be kept").split() == ["12.0", "1", "1"]
    assert ran(package, tells="cannot be kept").split() == ["12.0", "1", "1"]


def test_a_changed_source_is_compiled_anew(package: Path):
    (package / "_some_kernels.py").write_text(KERNELS.replace("2.0", "3.0"))
    assert ran(package).split() == ["27.0", "1", "1"]
    assert compiled(package) == 2


def test_another_processor_has_a_file_of_its_own(package: Path, monkeypatch):
    monkeypatch.setenv("NUMBA_CPU_NAME", "generic")
    monkeypatch.setenv("NUMBA_CPU_FEATURES", "")
    assert ran(package).split() == ["12.0", "1", "1"]
    assert compiled(package) == 2
    assert len(list((package / "__pycache__").glob("kernels-*"))) == 2


def test_every_source_of_a_kernel_is_looked_at_for_changes():
    sources = {path for path in PACKAGE.rglob("*.py") if "@njit" in path.read_text()}
    assert sources
    assert sources <= set(PACKAGE.rglob(SOURCES))
