"""The table of goals: what stands beside what, over figures that nobody has measured."""

import re
from contextlib import contextmanager
from types import SimpleNamespace

import pytest

from tests.benchmarks import (
    against,
    checkouts,
    demo,
    goals,
    idle,
    overhead,
    simplex,
    throughput,
)
from tests.benchmarks.checkouts import NoCheckoutError
from tests.benchmarks.goals import GOALS

ROUNDS = 2
PROBED = {
    "fits": [
        "SES fit, 480x640",
        "SES fit, 960x1280",
        "pictures and meshes, 480x640",
        "pictures and meshes, 960x1280",
    ],
    "uploads": ["upload of 12 megapixels to result and files"],
    "several": ["front and side over a single fit"],
}


@pytest.fixture(autouse=True)
def measured(monkeypatch, tmp_path):
    """Every measurement answers at once."""

    def figures(checkout, probe, count):
        if probe == "several":
            return dict.fromkeys(PROBED[probe], 1.75)
        return dict.fromkeys(PROBED[probe], 4.0 if checkout == tmp_path else 2.0)

    @contextmanager
    def baseline(_):
        yield tmp_path

    monkeypatch.setattr(against, "figures", figures)
    monkeypatch.setattr(checkouts, "checkout_of", baseline)
    monkeypatch.setattr(idle, "measured", lambda count: [SimpleNamespace(share_mib=380.0)] * count)
    monkeypatch.setattr(demo, "measured", lambda count: [4.0, 4.5, 6.0])
    monkeypatch.setattr(
        overhead,
        "measured",
        lambda count: [SimpleNamespace(served_share=share) for share in (0.85, 0.88, 0.93)],
    )
    monkeypatch.setattr(
        simplex, "measured", lambda count: [SimpleNamespace(times_slower=times) for times in (1, 2)]
    )
    monkeypatch.setattr(throughput, "measured", lambda count: {1: 1.0, 2: 1.95})


def table(lines) -> dict[str, list[str]]:
    """Cells by what stands in the first column."""
    rows = [re.split(r" {2,}", line.strip()) for line in lines]
    return {name: cells for name, *cells in rows}


def test_every_figure_has_a_goal_and_every_goal_a_figure():
    rows = table(goals.lines(ROUNDS))
    assert len({goal.figure for goal in GOALS}) == len(GOALS)
    for goal in GOALS:
        *_, bound, judged = rows[goal.figure]
        assert bound == str(goal)
        assert judged in {"met", "missed"}
    probed = {name for probe in PROBED.values() for name in probe}
    assert probed < {goal.figure for goal in GOALS}


def test_figures_are_medians_with_their_range():
    rows = table(goals.lines(ROUNDS))
    assert rows["the service's own cost on small SE fits"] == [
        "12.00",
        "7.00",
        "15.00",
        "at most 10 %",
        "missed",
    ]
    assert rows["`maquette demo`, warm"] == ["4.50", "4.00", "6.00", "at most 5 s", "met"]
    assert rows["upload of 12 megapixels to result and files"] == [
        "0.50",
        "0.50",
        "0.50",
        "at most 0.5 of the baseline",
        "met",
    ]


def test_without_the_baseline_its_rows_say_so_and_all_others_are_there(monkeypatch):
    @contextmanager
    def nowhere(_):
        message = "no such commit"
        raise NoCheckoutError(message)
        yield

    monkeypatch.setattr(checkouts, "checkout_of", nowhere)
    lines = list(goals.lines(ROUNDS))
    rows = table(lines)
    missing = {goal.figure for goal in GOALS if rows[goal.figure][-1] == "not measured"}
    assert missing == {goal.figure for goal in GOALS if goal.unit == goals.OF_BASELINE}
    assert "no such commit" in " ".join(lines)
