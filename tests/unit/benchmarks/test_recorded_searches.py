"""The benchmark's record of what a fit searched."""

import pytest

from fitter.fits import outline_search, pipeline, search
from fitter.optimizer.gauss_newton import minimize_gauss_newton
from fitter.optimizer.search import body_search
from tests.benchmarks.recorded_searches import recorded_searches
from tests.benchmarks.requests import suite_requests


def ignore(_):
    """Observe nothing."""


def test_a_recorded_search_is_the_one_the_fit_made():
    (request,) = suite_requests(1, width=240, height=320)
    unwatched = pipeline.fit(request)
    with recorded_searches() as searches:
        watched = pipeline.fit(request)
    assert dict(watched.energies) == pytest.approx(dict(unwatched.energies))
    last = searches[-1]
    assert last.end.candidate.bodies[0] is watched.found.person.body
    again = minimize_gauss_newton(
        last.objective,
        last.start,
        max_evaluations=last.end.evaluations,
        on_energies=ignore,
        settled_nats=last.settled_nats,
    )
    assert again.candidate.total == pytest.approx(last.end.candidate.total)


def test_the_record_ends_with_its_context():
    with recorded_searches():
        assert all(module.body_search is not body_search for module in (outline_search, search))
    assert all(module.body_search is body_search for module in (outline_search, search))
