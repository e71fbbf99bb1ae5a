"""Which starts are searched on; energies are numbers in place of bodies."""

from types import SimpleNamespace

import jaxtyping
import pytest

from fitter.optimizer.search import try_hypotheses


@pytest.fixture(autouse=True)
def numbers_for_bodies(monkeypatch):
    monkeypatch.setattr(jaxtyping.config, "jaxtyping_disable", True)


class Bowl:
    """An energy with its least value at 0; ``evaluate`` gives what a search would end with."""

    def evaluate(self, bodies: list[float | SimpleNamespace]) -> SimpleNamespace:
        where = place(*bodies)
        return SimpleNamespace(views=[SimpleNamespace(parameters=where)], total=where**2)


def place(body: float | SimpleNamespace) -> float:
    """Of a start, or of what a search ended with."""
    return body if isinstance(body, float) else body.parameters


def nearer(factor: float, visited: list[float]):
    def search(objective: Bowl, start: list[float | SimpleNamespace]) -> SimpleNamespace:
        visited.append(place(*start))
        end = objective.evaluate([factor * place(*start)])
        return SimpleNamespace(candidate=end, evaluations=3)

    return search


def test_only_the_best_ends_are_searched_on_and_the_best_of_those_wins():
    first: list[float] = []
    second: list[float] = []
    tried = try_hypotheses(
        Bowl(),
        Bowl(),
        [8.0, 2.0, 4.0, 16.0],
        trial=nearer(0.5, first),
        contenders=2,
        hopeless_nats=100.0,
        contest=nearer(0.25, second),
    )
    assert first == [8.0, 2.0, 4.0, 16.0]
    assert second == [1.0, 2.0]
    assert tried.totals == (16.0, 0.0625, 0.25, 64.0)
    assert tried.best == 1
    assert tried.winner.parameters == 0.25
    assert tried.evaluations == 3 * 4 + 3 * 2 + 4


def test_one_start_alone_is_the_best_and_not_searched_on():
    second: list[float] = []
    tried = try_hypotheses(
        Bowl(),
        Bowl(),
        [3.0],
        trial=nearer(0.5, []),
        contenders=2,
        hopeless_nats=1.0,
        contest=nearer(0.5, second),
    )
    assert tried.best == 0
    assert tried.winner.parameters == 1.5
    assert tried.totals == (2.25,)
    assert second == []


def test_what_ends_far_above_the_best_is_not_searched_on():
    second: list[float] = []
    tried = try_hypotheses(
        Bowl(),
        Bowl(),
        [8.0, 2.0, 3.0],
        trial=nearer(0.5, []),
        contenders=3,
        hopeless_nats=10.0,
        contest=nearer(0.5, second),
    )
    assert second == [1.0, 1.5]
    assert tried.totals == (16.0, 0.25, 0.5625)
    assert tried.best == 1
