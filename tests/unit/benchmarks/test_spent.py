"""The accounts of time that the benchmarks print."""

import pytest

from fitter.fits.progress import Stage
from tests.benchmarks import spent
from tests.benchmarks.requests import suite_requests


def test_the_stages_of_a_fit_are_parts_of_the_whole():
    (request,) = suite_requests(1, width=240, height=320)
    fitted = spent.timed_fit(request)
    assert set(fitted.stages) == set(Stage) - {Stage.EXPORT}
    for clock in ("processor_s", "wall_s"):
        parts = sum(getattr(each, clock) for each in fitted.stages.values())
        assert 0.0 < parts <= getattr(fitted.whole, clock)
    for stage, seconds in fitted.result.stage_seconds.items():
        assert fitted.stages[Stage(stage)].wall_s >= seconds - 1e-3


def test_nineteen_of_twenty_are_no_later_than_the_late_figure():
    values = [float(value) for value in range(1, 101)]
    assert sum(value <= spent.late(values) for value in values) == 95
    assert spent.median(values) == pytest.approx(50.5)
