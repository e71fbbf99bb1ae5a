"""The loop of damped steps, on energies of one number."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest

from fitter.numerics import _damping_kernels as kernels
from fitter.numerics.damped_descent import Offer, damped_steps, descend


@dataclass(frozen=True)
class Place:
    """A number with its energy."""

    at: Any
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
    assert kernels.after_gain(kernels.Damping(0.1, 8.0), gain).share == pytest.approx(0.1 * change)


def test_damping_rises_twice_as_fast_with_every_rejection_until_a_step_gains() -> None:
    first = kernels.after_rejection(kernels.Damping(0.1, 2.0))
    second = kernels.after_rejection(first)
    assert (first.share, second.share) == pytest.approx((0.2, 0.8))
    assert kernels.after_gain(second, 0.5).rise == 2.0


def test_a_step_solves_the_damped_equations_and_promises_what_the_paraboloid_falls() -> None:
    rng = np.random.default_rng(4)
    root, gradient = rng.standard_normal((9, 9)), rng.standard_normal(9)
    matrix = root @ root.T
    offer = damped_steps(matrix, gradient, lambda step: Place(step, 0.0), floor=0.1)(0.5)
    reached = offer.taken()
    assert reached is not None
    step = reached.at
    damped = matrix + np.diag(0.5 * matrix.diagonal() + 0.1)
    np.testing.assert_allclose(damped @ step, -gradient, atol=1e-9)
    assert offer.promised == pytest.approx(-(gradient @ step + 0.5 * step @ matrix @ step))
