"""Many fits, one after the other or in several processes."""

import multiprocessing
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from fitter.request import Cues
from tests.evaluation.scene import Case
from tests.evaluation.sheets import write_pictures
from tests.evaluation.suite import Scored, Told, fit_case, score


@dataclass(frozen=True, slots=True, kw_only=True)
class Run:
    """What every fit is told, and the folder its pictures go to, if any."""

    told: Told
    pictures: Path | None


def score_all(cases: Sequence[Case], run: Run, *, jobs: int) -> Iterator[list[Scored]]:
    """SE and SES of each picture, in order; ``jobs`` processes, each with whole pictures."""
    if jobs == 1:
        yield from map(partial(_score_both, run), cases)
        return
    with multiprocessing.get_context("spawn").Pool(jobs) as pool:
        yield from pool.imap(partial(_score_both, run), cases)


def _score_both(run: Run, case: Case) -> list[Scored]:
    fits = [fit_case(case, cues, run.told) for cues in Cues]
    if run.pictures is not None:
        write_pictures(run.pictures, fits)
    return [score(fitted) for fitted in fits]
