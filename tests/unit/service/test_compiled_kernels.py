"""Kernels read from their cache without a call."""

import os
import subprocess
import sys
import textwrap
from pathlib import Path

REPOSITORY = Path(__file__).parents[3]

INNER = """
from numba import njit

@njit(cache=True, inline="never")
def doubled(value):
    return 2.0 * value
"""

CALLED = """
from fitter.inner_kernels import doubled
print(doubled(1.0))
"""

LOADED = """
import fitter.inner_kernels as inner
from numba import njit
from service.worker.compiled_kernels import load_compiled_kernels

assert load_compiled_kernels() == 1.0
(compiled,) = inner.doubled.overloads.values()
print(type(compiled.library._shared_module).__name__)
load_compiled_kernels()

@njit
def quadrupled(value):
    return inner.doubled(inner.doubled(value))

print(quadrupled(3.0), inner.doubled(3.0), len(inner.doubled.overloads))
"""


def printed(program: str, folder: Path) -> list[str]:
    """What a process prints that has a module of the fitter's with one kernel."""
    begin = f"import fitter\nfitter.__path__.append({str(folder)!r})\n"
    done = subprocess.run(
        [sys.executable, "-c", begin + textwrap.dedent(program)],
        cwd=REPOSITORY,
        env=os.environ | {"NUMBA_CACHE_DIR": str(folder / "kernels")},
        capture_output=True,
        text=True,
        check=True,
    )
    return done.stdout.split()


def test_what_is_compiled_later_can_call_a_kernel_that_was_read(tmp_path):
    (tmp_path / "inner_kernels.py").write_text(INNER)
    assert printed(CALLED, tmp_path) == ["2.0"]
    assert printed(LOADED, tmp_path) == ["_Bitcode", "12.0", "6.0", "1"]
