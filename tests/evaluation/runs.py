"""Many fits, one after the other or in several processes."""

import multiprocessing
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TypeVar

from fitter.request import Clothing, Cues
from tests.evaluation.scene import Case
from tests.evaluation.sheets import write_pictures
from tests.evaluation.suite import Scored, Told, fit_case, score

Found = TypeVar("Found")
Item = TypeVar("Item")


@dataclass(frozen=True, slots=True, kw_only=True)
class Run:
    """What every fit is told, and the folder its pictures go to, if any."""

    told: Told
    pictures: Path | None


def score_all(cases: Sequence[Case], run: Run, *, jobs: int) -> Iterator[list[Scored]]:
    """SE and SES of each picture, in order; ``jobs`` processes, each with whole pictures."""
    return of_each(partial(_score_both, run), cases, jobs)


def score_dressed(cases: Sequence[Case], *, jobs: int) -> list[tuple[Clothing, Scored]]:
    """Each picture by SES, its clothes said to be tight and loose."""
    return [pair for pairs in of_each(_score_dressed, cases, jobs) for pair in pairs]


def of_each(task: Callable[[Item], Found], cases: Sequence[Item], jobs: int) -> Iterator[Found]:
    """What comes of each, in order; ``jobs`` processes."""
    if jobs == 1:
        yield from map(task, cases)
        return
    with multiprocessing.get_context("spawn").Pool(jobs) as pool:
        yield from pool.imap(task, cases)


def _score_both(run: Run, case: Case) -> list[Scored]:
    fits = [fit_case(case, cues, run.told) for cues in Cues]
    if run.pictures is not None:
        write_pictures(run.pictures, fits)
    return [score(fitted) for fitted in fits]


def _score_dressed(case: Case) -> list[tuple[Clothing, Scored]]:
    return [
        (clothing, score(fit_case(case, Cues.SES, Told(clothing=clothing))))
        for clothing in Clothing
    ]
