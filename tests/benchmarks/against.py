"""This checkout against another one, in turns: ratios, which a busy machine leaves alone."""

import json
import os
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from fitter.training.report.text_tables import note_lines, table_lines

ROUNDS = 3
PROBE = Path(__file__).with_name("probe.py")
HERE = PROBE.parents[2]

FITS = {"fits": 7, "uploads": 3, "scans": 3}
"""What is compared, see :mod:`tests.benchmarks.probe`, and over how many fits a round."""


def lines(baseline: Path) -> Iterator[str]:
    """A row a figure: medians of both checkouts over three rounds, and of the rounds' ratios."""
    theirs: dict[str, list[float]] = {}
    ours: dict[str, list[float]] = {}
    for probe in FITS:
        for _ in range(ROUNDS):
            for checkout, found in ((baseline.resolve(), theirs), (HERE, ours)):
                for name, figure in _figures(checkout, probe).items():
                    found.setdefault(name, []).append(figure)
    yield from table_lines(
        f"This checkout against {baseline.name}, {ROUNDS} rounds in turns, seconds or shares",
        ("", "there", "here", "ratio"),
        [
            (
                name,
                f"{np.median(theirs[name]):.3f}",
                f"{np.median(ours[name]):.3f}",
                f"{np.median(np.divide(ours[name], theirs[name])):.2f}",
            )
            for name in theirs
        ],
    )
    yield from note_lines("Fits, pictures and meshes: processor time; the upload: wall time.")


def _figures(checkout: Path, probe: str) -> dict[str, float]:
    environment = {**os.environ, "PYTHONPATH": str(checkout), "MAQUETTE_LOG_LEVEL": "WARNING"}
    finished = subprocess.run(
        [sys.executable, "-P", str(PROBE), probe, str(FITS[probe])],
        cwd=checkout,
        env=environment,
        stdout=subprocess.PIPE,
        check=True,
        text=True,
    )
    return json.loads(finished.stdout.splitlines()[-1])
