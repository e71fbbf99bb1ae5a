"""The table of goals, with figures that nobody measured."""

from contextlib import contextmanager
from pathlib import Path

import pytest

from tests.benchmarks import against, baseline, goals
from tests.benchmarks.against import Comparison

FIGURES = [goal.figure for goal in (*goals.OF_BASELINE, goals.SCAN, *goals.OWN)]


@pytest.fixture
def measured(monkeypatch):
    """Every figure is at its bound, and the baseline is this checkout."""
    monkeypatch.setattr(goals, "OWN", {goal: lambda _, goal=goal: goal.bound for goal in goals.OWN})

    @contextmanager
    def checkout():
        yield Path()

    monkeypatch.setattr(baseline, "checkout", checkout)
    monkeypatch.setattr(
        against,
        "comparisons",
        lambda _: {
            goal.figure: Comparison(there=1.0, here=goal.bound, ratio=goal.bound)
            for goal in (*goals.OF_BASELINE, goals.SCAN)
        },
    )


def test_every_figure_has_a_row_with_its_goal(measured):
    table = list(goals.lines(1))
    for figure in FIGURES:
        (row,) = (line for line in table if figure in line)
        assert row.rstrip().endswith("met")
        assert "<=" in row or ">=" in row


def test_what_is_compared_is_what_the_probes_tell():
    probe = Path(against.PROBE).read_text()
    for goal in (*goals.OF_BASELINE, goals.SCAN):
        assert goal.figure.split(",")[0] in probe


def test_a_bound_is_met_from_its_own_side():
    most = goals.Goal(figure="a", bound=0.5)
    least = goals.Goal(figure="b", bound=1.9, at_most=False)
    assert [most.row(value)[-1] for value in (0.5, 0.51)] == ["met", "missed"]
    assert [least.row(value)[-1] for value in (1.9, 1.89)] == ["met", "missed"]
    assert most.row(None)[-1] == "not measured"


def test_without_the_baseline_its_rows_are_not_measured_and_it_says_why(measured, monkeypatch):
    @contextmanager
    def nothing():
        reason = "fatal: invalid reference"
        raise baseline.NoBaselineError(reason)
        yield

    monkeypatch.setattr(baseline, "checkout", nothing)
    table = "\n".join(goals.lines(1))
    assert table.count("not measured") == len(goals.OF_BASELINE) + 1
    assert "invalid reference" in table


def test_a_folder_is_its_own_checkout(tmp_path):
    with baseline.checkout(tmp_path) as folder:
        assert folder == tmp_path.resolve()


def test_a_revision_that_git_lacks_is_told():
    with pytest.raises(baseline.NoBaselineError), baseline.checkout("no-such-revision"):
        pass
