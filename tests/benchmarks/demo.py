"""What ``maquette demo`` takes: a service is started, a sample fitted, its files are kept."""

import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator, Sequence
from pathlib import Path

from fitter.training.report.text_tables import note_lines
from tests.benchmarks.spent import median

COMMAND = (sys.executable, "-P", "-m", "service.cli", "demo")


def walls_s(count: int) -> Sequence[float]:
    """Wall seconds of ``count`` demos, after one that warms the caches."""
    return [_wall_s() for _ in range(count + 1)][1:]


def lines(count: int) -> Iterator[str]:
    """The median, the fastest and the slowest."""
    taken = walls_s(count)
    yield from note_lines(
        f"`maquette demo`, {count} times after a first one: median {median(taken):.1f} s, "
        f"{min(taken):.1f} to {max(taken):.1f} s."
    )


def _wall_s() -> float:
    with tempfile.TemporaryDirectory(prefix="maquette-benchmark-") as folder:
        began = time.monotonic()
        subprocess.run(
            [*COMMAND, "--output", str(Path(folder) / "output")],
            stdout=subprocess.DEVNULL,
            check=True,
        )
        return time.monotonic() - began
