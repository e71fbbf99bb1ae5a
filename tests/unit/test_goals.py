"""The table of goals, over figures that nobody has measured."""

import re

import pytest

from tests.benchmarks import against
from tests.benchmarks.against import HERE
from tests.benchmarks.goals import GOALS, Goal, lines


def test_a_figure_is_the_median_with_its_range_beside_its_goal():
    goals = (
        Goal(figure="cost", measured=lambda: [7.0, 12.0, 15.0], bound=10.0, unit="%"),
        Goal(figure="rate", measured=lambda: [1.95], bound=1.9, at_least=True),
    )
    rows = {
        name: cells for name, *cells in (re.split(r" {2,}", row.strip()) for row in lines(goals))
    }
    assert rows["cost"] == ["12.00", "7.00", "15.00", "at most 10 %", "missed"]
    assert rows["rate"] == ["1.95", "1.95", "1.95", "at least 1.9", "met"]
    assert len({goal.figure for goal in GOALS}) == len(GOALS)


def test_ratios_are_taken_round_by_round_after_an_untimed_run_of_each(monkeypatch, tmp_path):
    asked = []

    def figures(checkout, count):
        asked.append((checkout == HERE, count))
        rounds = len(asked)
        return {"a figure": float(rounds if checkout == HERE else 2 * rounds)}

    monkeypatch.setattr(against, "figures", figures)
    (compared,) = against.measured(tmp_path, fits=4, rounds=2)
    assert asked == [(False, 1), (True, 1), *[(False, 4), (True, 4)] * 2]
    assert compared.there == (6.0, 10.0)
    assert compared.here == (4.0, 6.0)
    assert compared.ratios == pytest.approx((2 / 3, 0.6))
