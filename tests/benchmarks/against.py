"""This checkout against another one, in turns: ratios, which a busy machine leaves alone."""

import json
import os
import subprocess
import sys
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from statistics import median

from fitter.training.report.text_tables import note_lines, table_lines
from tests.benchmarks.checkouts import HERE, NoCheckoutError, checkout_of

ROUNDS = 3
PROBE = Path(__file__).with_name("probe.py")

FITS = {"fits": 7, "uploads": 3, "several": 3}
"""What is compared, see :mod:`tests.benchmarks.probe`, and over how many fits a round."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Compared:
    """A figure of both checkouts, round by round."""

    name: str
    there: tuple[float, ...]
    here: tuple[float, ...]

    @property
    def ratios(self) -> tuple[float, ...]:
        """This checkout's over the other's."""
        return tuple(ours / theirs for ours, theirs in zip(self.here, self.there, strict=True))


def lines(wanted: str) -> Iterator[str]:
    """A row a figure: medians of both checkouts over three rounds, and of the rounds' ratios."""
    try:
        with checkout_of(wanted) as other:
            compared = measured(other, fits=FITS, rounds=ROUNDS)
    except NoCheckoutError as error:
        yield from note_lines(f"Nothing to compare with: {error}.")
        return
    yield from table_lines(
        f"This checkout against {wanted}, {ROUNDS} rounds in turns, seconds or shares",
        ("", "there", "here", "ratio"),
        [
            (
                each.name,
                f"{median(each.there):.3f}",
                f"{median(each.here):.3f}",
                f"{median(each.ratios):.2f}",
            )
            for each in compared
        ],
    )
    yield from note_lines("Fits, pictures and meshes: processor time; the upload: wall time.")


def measured(other: Path, *, fits: Mapping[str, int], rounds: int) -> list[Compared]:
    """Both checkouts' figures, in turns.

    Each probe runs once untimed in either before: what is compiled at first use is compiled then.
    """
    for checkout in (other, HERE):
        for probe in fits:
            figures(checkout, probe, 1)
    theirs: dict[str, list[float]] = {}
    ours: dict[str, list[float]] = {}
    for probe, count in fits.items():
        for _ in range(rounds):
            for checkout, found in ((other, theirs), (HERE, ours)):
                for name, figure in figures(checkout, probe, count).items():
                    found.setdefault(name, []).append(figure)
    return [
        Compared(name=name, there=tuple(there), here=tuple(ours[name]))
        for name, there in theirs.items()
    ]


def figures(checkout: Path, probe: str, count: int) -> dict[str, float]:
    """What a probe finds in a checkout over so many fits."""
    environment = {**os.environ, "PYTHONPATH": str(checkout), "MAQUETTE_LOG_LEVEL": "WARNING"}
    finished = subprocess.run(
        [sys.executable, "-P", str(PROBE), probe, str(count)],
        cwd=checkout,
        env=environment,
        stdout=subprocess.PIPE,
        check=True,
        text=True,
    )
    return json.loads(finished.stdout.splitlines()[-1])
