"""A bucket that fills evenly, and what a caller is told to wait."""

import pytest

from service.api.rate_limit import TokenBucket, whole_seconds


def bucket(tokens: float) -> TokenBucket:
    return TokenBucket(capacity=40.0, per_second=0.5, tokens=tokens, filled_at=100.0)


def test_what_comes_in_is_the_rate_times_the_time():
    filled = bucket(3.0)
    filled.fill(104.0)
    assert (filled.tokens, filled.filled_at) == (5.0, 104.0)


def test_it_does_not_overflow():
    filled = bucket(39.0)
    filled.fill(1_000.0)
    assert filled.tokens == 40.0
    assert filled.is_full


@pytest.mark.parametrize(("tokens", "wait_s"), [(0.0, 2.0), (0.75, 0.5), (1.0, 0.0), (7.0, 0.0)])
def test_the_wait_is_that_for_a_whole_token(tokens: float, wait_s: float):
    assert bucket(tokens).wait_s == wait_s


@pytest.mark.parametrize(("wait_s", "told"), [(0.0, 1), (0.05, 1), (1.0, 1), (1.01, 2), (59.2, 60)])
def test_callers_are_told_whole_seconds_and_at_least_one(wait_s: float, told: int):
    assert whole_seconds(wait_s) == told
