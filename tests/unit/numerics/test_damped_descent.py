"""The loop of damped steps, on energies of one number."""

from collections.abc import Callable
from dataclasses import dataclass

import pytest

from fitter.numerics.damped_descent import Offer, damping_change, descend


@dataclass(frozen=True)
class Place:
    """A number with its energy."""

    at: float
    total: float


def searched(
    energy: Callable[[float], float], *, start: float, max_evaluations: int = 100
) -> tuple[Place, bool, list[float]]:
    """End, convergence and every place that was evaluated, of a search that believes in x² / 2."""
    tried: list[float] = []

    def evaluated(at: float) -> Place:
        tried.append(at)
        return Place(at, energy(at))

    def paraboloid(now: Place) -> Callable[[float], Offer[Place]]:
        def offered(damping: float) -> Offer[Place]:
            step = -now.at / (1.0 + damping)
            promised = -(now.at * step + 0.5 * step * step)
            return Offer(promised=promised, taken=lambda: evaluated(now.at + step))

        return offered

    found = descend(evaluated(start), paraboloid, max_evaluations=max_evaluations, settled=0.05)
    assert found.evaluations == len(tried)
    return found.point, found.converged, tried


def test_a_paraboloid_is_descended_to_its_minimum() -> None:
    end, converged, _ = searched(lambda x: 0.5 * x * x, start=8.0)
    assert converged
    assert end.total < 0.05


def test_after_a_rejection_a_step_is_tried_only_where_it_promises_clearly_less() -> None:
    # Whatever lies nearer than 1 costs more than the start: only a much shorter step gains.
    _, _, (_, rejected, taken, *_) = searched(lambda x: 0.5 * x * x if x > 1.0 else 40.0, start=4.0)
    assert rejected < 1.0 < taken
    assert 16.0 - taken**2 <= 0.7 * (16.0 - rejected**2)


def test_an_energy_that_no_step_lowers_ends_the_search_where_it_began() -> None:
    end, converged, tried = searched(lambda x: -abs(x), start=2.0)
    assert converged
    assert end.at == 2.0
    assert len(tried) < 20


def test_a_search_stops_when_it_may_compute_no_more() -> None:
    _, converged, tried = searched(lambda x: 0.5 * x * x, start=1e6, max_evaluations=2)
    assert not converged
    assert len(tried) == 2


@pytest.mark.parametrize(
    ("gain", "change"), [(0.5, 1.0), (1.0, 1.0 / 3.0), (2.0, 1.0 / 3.0), (0.0, 2.0), (-1.0, 5.0)]
)
def test_damping_falls_where_a_step_kept_its_promise_and_rises_where_it_did_not(
    gain: float, change: float
) -> None:
    assert damping_change(gain) == pytest.approx(change)
