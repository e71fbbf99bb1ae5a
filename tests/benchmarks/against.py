"""This checkout against another one, in turns: ratios, which a busy machine leaves alone."""

import json
import os
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from statistics import median

from fitter.training.report.survey_comparison import note_lines, table_lines

HERE = Path(__file__).parents[2]

ROUNDS = 3
FITS = 7
PROBE = Path(__file__).with_name("probe.py")


class NoCheckoutError(Exception):
    """A revision cannot be had; the message says why."""


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
    """A row a figure: medians of both checkouts over the rounds, and of the rounds' ratios."""
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
    yield from note_lines("Processor time.")


def measured(other: Path, *, fits: int, rounds: int) -> list[Compared]:
    """Both checkouts' figures, in turns.

    The probe runs once untimed in either before: what is compiled at first use is compiled then.
    """
    for checkout in (other, HERE):
        figures(checkout, 1)
    theirs: dict[str, list[float]] = {}
    ours: dict[str, list[float]] = {}
    for _ in range(rounds):
        for checkout, found in ((other, theirs), (HERE, ours)):
            for name, figure in figures(checkout, fits).items():
                found.setdefault(name, []).append(figure)
    return [
        Compared(name=name, there=tuple(there), here=tuple(ours[name]))
        for name, there in theirs.items()
    ]


def figures(checkout: Path, count: int) -> dict[str, float]:
    """Figures of a checkout over so many fits, by the probe."""
    environment = {**os.environ, "PYTHONPATH": str(checkout), "MAQUETTE_LOG_LEVEL": "WARNING"}
    finished = subprocess.run(
        [sys.executable, "-P", str(PROBE), str(count)],
        cwd=checkout,
        env=environment,
        stdout=subprocess.PIPE,
        check=True,
        text=True,
    )
    return json.loads(finished.stdout.splitlines()[-1])


@contextmanager
def checkout_of(wanted: str) -> Iterator[Path]:
    """The folder of this name; else the revision, in a folder that goes with the context.

    Raises
    ------
    NoCheckoutError
        If it is no folder, and git or this clone does not have the revision.
    """
    if Path(wanted).is_dir():
        yield Path(wanted).resolve()
        return
    commit = _commit(wanted)
    with tempfile.TemporaryDirectory(prefix="maquette-benchmark-") as folder:
        checkout = Path(folder) / "checkout"
        _git("worktree", "add", "--detach", str(checkout), commit)
        try:
            yield checkout
        finally:
            _git("worktree", "remove", "--force", str(checkout))


def _commit(revision: str) -> str:
    try:
        return _git("rev-parse", "--verify", "--end-of-options", f"{revision}^{{commit}}")
    except NoCheckoutError as error:
        message = f"{revision} is no folder, and no commit that can be had here ({error})"
        raise NoCheckoutError(message) from error


def _git(*arguments: str) -> str:
    try:
        finished = subprocess.run(
            ["git", "-C", str(HERE), *arguments],
            capture_output=True,
            check=True,
            text=True,
        )
    except OSError as error:
        message = f"git: {error.strerror}"
        raise NoCheckoutError(message) from error
    except subprocess.CalledProcessError as error:
        raise NoCheckoutError(error.stderr.strip()) from error
    return finished.stdout.strip()
