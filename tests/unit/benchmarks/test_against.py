"""Two checkouts in turns."""

import pytest

from tests.benchmarks import against
from tests.benchmarks.against import HERE


def test_ratios_are_taken_round_by_round_after_an_untimed_run_of_each(monkeypatch, tmp_path):
    asked = []

    def figures(checkout, probe, count):
        asked.append((checkout == HERE, probe, count))
        rounds = len(asked)
        return {"a figure": float(rounds if checkout == HERE else 2 * rounds)}

    monkeypatch.setattr(against, "figures", figures)
    (compared,) = against.measured(tmp_path, fits={"fits": 4}, rounds=2)
    assert asked == [
        (False, "fits", 1),
        (True, "fits", 1),
        *[(False, "fits", 4), (True, "fits", 4)] * 2,
    ]
    assert compared.there == (6.0, 10.0)
    assert compared.here == (4.0, 6.0)
    assert compared.ratios == pytest.approx((2 / 3, 0.6))
