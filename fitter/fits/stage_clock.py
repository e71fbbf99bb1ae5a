"""Times the stages of a fit and reports its progress."""

import time
from collections.abc import Iterator, Mapping
from contextlib import contextmanager

from fitter.energies.objective import EnergyObserver
from fitter.fits.progress import Observer, Progress, Stage

# Where each stage begins, as a share of a typical fit's time (640x480, Gauss-Newton, SES).
_BEGINS_AT: Mapping[Stage, float] = {
    Stage.OBSERVATION: 0.0,
    Stage.INITIAL_POSE: 0.04,
    Stage.SEGMENTATION: 0.08,
    Stage.SILHOUETTE_AND_EDGES: 0.16,
    Stage.SHADING: 0.45,
    Stage.MEASUREMENT: 0.92,
    Stage.EXPORT: 0.96,
}
# The number of steps in a stage is not known in advance: each takes this share of what is left.
_STEP_SHARE = 0.04


class StageClock:
    """Wall time by stage, and progress that never goes back."""

    def __init__(self, observer: Observer) -> None:
        self._observer = observer
        self._seconds: dict[str, float] = {}
        self._fraction = 0.0

    @property
    def seconds(self) -> Mapping[str, float]:
        """Wall seconds by stage name, for the stages that have ended."""
        return dict(self._seconds)

    @contextmanager
    def stage(self, stage: Stage) -> Iterator[EnergyObserver]:
        """Run one stage; the yielded function takes energies to report."""
        stages = list(_BEGINS_AT)
        following = stages.index(stage) + 1
        end = _BEGINS_AT[stages[following]] if following < len(stages) else 1.0
        self._fraction = max(self._fraction, _BEGINS_AT[stage])
        self._observer(Progress(stage=stage, fraction=self._fraction))

        def report(energies: Mapping[str, float]) -> None:
            self._fraction += _STEP_SHARE * (end - self._fraction)
            self._observer(Progress(stage=stage, fraction=self._fraction, energies=energies))

        begin = time.perf_counter()
        yield report
        self._seconds[stage.value] = time.perf_counter() - begin
