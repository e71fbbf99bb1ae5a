"""`maquette demo` as whoever has run it before sees it: wall seconds of the whole command."""

import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from statistics import median

from fitter.training.report.survey_comparison import note_lines
from tests.deployment import REPOSITORY


def lines(count: int) -> Iterator[str]:
    """``count`` runs, one after the other."""
    taken = measured(count)
    yield from note_lines(
        f"`maquette demo` {count} times: median {median(taken):.2f} s, {min(taken):.2f} to "
        f"{max(taken):.2f}. A run before them, which compiles the kernels if they are not yet, is "
        "not counted."
    )


def measured(count: int) -> list[float]:
    """Wall seconds of runs, without those of one before them."""
    return [_run() for _ in range(1 + count)][1:]


def _run() -> float:
    with tempfile.TemporaryDirectory(prefix="maquette-benchmark-") as folder:
        began = time.monotonic()
        subprocess.run(
            [sys.executable, "-m", "service.cli", "demo", "--output", folder],
            cwd=REPOSITORY,
            stdout=subprocess.DEVNULL,
            check=True,
        )
        return time.monotonic() - began
