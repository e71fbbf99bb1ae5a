"""Processor and wall time of a piece of work, by stage where it has stages.

Processor time is what a busy machine leaves alone; wall time is what a caller waits for.
"""

import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import TypeVar

import numpy as np

from fitter.export.bundle import result_files
from fitter.fits.pipeline import fit
from fitter.fits.prepared_model import prepared_model
from fitter.fits.progress import Progress, Stage
from fitter.request import FitRequest
from fitter.result import FitResult

Result = TypeVar("Result")


@dataclass(frozen=True, slots=True, kw_only=True)
class Spent:
    """Seconds of this process, all its threads, and of the clock on the wall."""

    processor_s: float
    wall_s: float

    def __sub__(self, earlier: "Spent") -> "Spent":
        return Spent(
            processor_s=self.processor_s - earlier.processor_s, wall_s=self.wall_s - earlier.wall_s
        )


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class TimedFit:
    """A fit with what it took, by stage and in all; ``export`` comes after, and is no part of it.

    ``export`` is the making of the result's pictures and meshes.
    """

    result: FitResult
    whole: Spent
    export: Spent
    stages: Mapping[Stage, Spent]


def now() -> Spent:
    """The two clocks."""
    return Spent(processor_s=time.process_time(), wall_s=time.perf_counter())


def timed(action: Callable[[], Result]) -> tuple[Result, Spent]:
    """A result and what it took."""
    began = now()
    result = action()
    return result, now() - began


def timed_fit(request: FitRequest) -> TimedFit:
    """Fit, and note when each stage reports itself for the first time."""
    begins: dict[Stage, Spent] = {}

    def observe(progress: Progress) -> None:
        if progress.stage not in begins:
            begins[progress.stage] = now()

    began = now()
    result = fit(request, observer=observe)
    end = now()
    ends = [*list(begins.values())[1:], end]
    model = prepared_model(result.person.gender).operators.model
    _, export = timed(
        lambda: result_files(result, model=model, images=[view.image for view in request.views])
    )
    return TimedFit(
        result=result,
        whole=end - began,
        export=export,
        stages={stage: ended - begins[stage] for stage, ended in zip(begins, ends, strict=True)},
    )


def median(values: Sequence[float]) -> float:
    """The middle one."""
    return float(np.median(values))


def late(values: Sequence[float]) -> float:
    """The 95th percentile."""
    return float(np.percentile(values, 95.0))
