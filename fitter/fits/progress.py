"""Progress of a running fit: stages, their time, and who is told."""

import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field
from enum import StrEnum

from fitter.energies.objective import EnergyObserver


class Stage(StrEnum):
    """The stages of a fit, in order."""

    OBSERVATION = "observation"
    INITIAL_POSE = "initial_pose"
    SEGMENTATION = "segmentation"
    SILHOUETTE_AND_EDGES = "silhouette_and_edges"
    SHADING = "shading"
    MEASUREMENT = "measurement"
    EXPORT = "export"


@dataclass(frozen=True, slots=True, kw_only=True)
class Progress:
    """One report.

    ``fraction`` is the share of the whole fit done so far, in [0, 1], never decreasing; ``view``
    which of several pictures is searched by itself, None where all are searched together and where
    there is one; ``energies`` are the named terms at the moment, empty before there are any.
    """

    stage: Stage
    fraction: float
    view: int | None = None
    energies: Mapping[str, float] = field(default_factory=dict[str, float])


Observer = Callable[[Progress], None]


def ignore_progress(_: Progress) -> None:
    """Observe nothing."""


# Where each stage begins, as a share of a typical fit's time (640x480, Gauss-Newton, SES): of the
# part in which every picture is searched by itself, and of the whole for what follows. Several
# pictures are searched by themselves for longer, because each is.
_BY_ITSELF: Mapping[Stage, float] = {
    Stage.OBSERVATION: 0.0,
    Stage.INITIAL_POSE: 0.13,
    Stage.SEGMENTATION: 0.27,
    Stage.SILHOUETTE_AND_EDGES: 0.53,
}
_TOGETHER_FROM_ONE, _TOGETHER_FROM_SEVERAL = 0.3, 0.45
_SHADING_FROM_ONE, _SHADING_FROM_SEVERAL = 0.45, 0.6
_MEASUREMENT_FROM, _EXPORT_FROM = 0.92, 0.96
# The number of steps in a stage is not known in advance: each takes this share of what is left.
_STEP_SHARE = 0.04


class StageClock:
    """Wall time by stage, and progress that never goes back, of a fit of so many pictures."""

    def __init__(self, observer: Observer, pictures: int) -> None:
        self._observer = observer
        self._pictures = pictures
        self._seconds: dict[str, float] = {}
        self._fraction = 0.0
        one = pictures == 1
        self._alone = _TOGETHER_FROM_ONE if one else _TOGETHER_FROM_SEVERAL
        self._together: Mapping[Stage, float] = {
            Stage.OBSERVATION: 0.0,
            Stage.SILHOUETTE_AND_EDGES: self._alone,
            Stage.SHADING: _SHADING_FROM_ONE if one else _SHADING_FROM_SEVERAL,
            Stage.MEASUREMENT: _MEASUREMENT_FROM,
            Stage.EXPORT: _EXPORT_FROM,
        }

    @property
    def seconds(self) -> Mapping[str, float]:
        """Wall seconds by stage name, of all pictures, for the stages that have ended."""
        return dict(self._seconds)

    @contextmanager
    def stage(self, stage: Stage) -> Iterator[EnergyObserver]:
        """Run one stage of all pictures together; the yielded function takes energies to report."""
        with self._running(stage, None, *_span(self._together, stage)) as report:
            yield report

    @contextmanager
    def stage_of(self, view: int, stage: Stage) -> Iterator[EnergyObserver]:
        """Run one stage of one picture by itself."""
        begin, end = (
            self._alone * (view + share) / self._pictures for share in _span(_BY_ITSELF, stage)
        )
        named = None if self._pictures == 1 else view
        with self._running(stage, named, begin, end) as report:
            yield report

    @contextmanager
    def _running(
        self, stage: Stage, view: int | None, begin: float, end: float
    ) -> Iterator[EnergyObserver]:
        self._fraction = max(self._fraction, begin)
        self._observer(Progress(stage=stage, fraction=self._fraction, view=view))

        def report(energies: Mapping[str, float]) -> None:
            self._fraction += _STEP_SHARE * (end - self._fraction)
            self._observer(
                Progress(stage=stage, fraction=self._fraction, view=view, energies=energies)
            )

        started = time.perf_counter()
        yield report
        before = self._seconds.get(stage.value, 0.0)
        self._seconds[stage.value] = before + time.perf_counter() - started


@dataclass(frozen=True, slots=True, kw_only=True)
class ViewClock:
    """The clock of one picture, by its place."""

    clock: StageClock
    view: int

    @contextmanager
    def stage(self, stage: Stage) -> Iterator[EnergyObserver]:
        """Run one stage of the picture."""
        with self.clock.stage_of(self.view, stage) as report:
            yield report


def _span(begins: Mapping[Stage, float], stage: Stage) -> tuple[float, float]:
    """Shares of the time at which a stage and the next one begin."""
    stages = list(begins)
    following = stages.index(stage) + 1
    return begins[stage], begins[stages[following]] if following < len(stages) else 1.0
