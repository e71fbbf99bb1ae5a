"""Many fits, one after the other or in several processes."""

import multiprocessing
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TypeVar

from fitter.vocabulary.choices import Cues
from tests.accuracy.cases import CASES
from tests.accuracy.dressed import dressed_names, dressed_picture
from tests.accuracy.foreign import foreign_picture
from tests.accuracy.scoring import Scored, fit_picture, score
from tests.accuracy.sheets import write_pictures
from tests.accuracy.true_picture import Told, TruePicture, case_picture

Found = TypeVar("Found")
Item = TypeVar("Item")


@dataclass(frozen=True, slots=True, kw_only=True)
class Run:
    """What every fit is told, and the folder its pictures go to, if any."""

    told: Told
    pictures: Path | None


def picture_of(name: str) -> TruePicture:
    """A picture of the suite's own, or one of bodies by another maker."""
    if name in CASES:
        return case_picture(CASES[name])
    return dressed_picture(name) if name in dressed_names() else foreign_picture(name)


def score_all(names: Sequence[str], run: Run, *, jobs: int) -> Iterator[list[Scored]]:
    """SE and SES of each picture, in order; ``jobs`` processes, each with whole pictures."""
    return of_each(partial(_score_both, run), names, jobs)


def of_each(task: Callable[[Item], Found], items: Sequence[Item], jobs: int) -> Iterator[Found]:
    """What comes of each, in order; ``jobs`` processes."""
    if jobs == 1:
        yield from map(task, items)
        return
    with multiprocessing.get_context("spawn").Pool(jobs) as pool:
        yield from pool.imap(task, items)


def _score_both(run: Run, name: str) -> list[Scored]:
    picture = picture_of(name)
    fits = [fit_picture(picture, cues, run.told) for cues in Cues]
    if run.pictures is not None:
        write_pictures(run.pictures, fits)
    return [score(fitted) for fitted in fits]
