"""The limit of requests: a bucket for each key, which fills evenly."""

from service.api.rate_limit import MOST_BUCKETS, RateLimit

KEY = "0123abcd"


class Clock:
    """A clock that is set by hand."""

    def __init__(self) -> None:
        self.now = 100.0

    def __call__(self) -> float:
        return self.now


def test_a_burst_passes_and_the_next_request_is_told_when():
    limit = RateLimit(per_minute=30, monotonic=Clock())
    assert [limit.take(KEY) for _ in range(31)] == [0] * 30 + [2]


def test_requests_pass_at_the_rate():
    clock = Clock()
    limit = RateLimit(per_minute=30, monotonic=clock)
    for _ in range(30):
        limit.take(KEY)
    clock.now += 1.5
    assert limit.take(KEY) == 1
    clock.now += 0.5
    assert [limit.take(KEY), limit.take(KEY)] == [0, 2]


def test_a_bucket_does_not_overflow():
    clock = Clock()
    limit = RateLimit(per_minute=30, monotonic=clock)
    limit.take(KEY)
    clock.now += 3_600.0
    assert [limit.take(KEY) for _ in range(31)].count(0) == 30


def test_keys_do_not_share_a_bucket():
    limit = RateLimit(per_minute=1, monotonic=Clock())
    assert [limit.take(KEY), limit.take("other"), limit.take(KEY)] == [0, 0, 60]


def test_what_is_full_again_is_forgotten_and_what_is_not_counts():
    clock = Clock()
    limit = RateLimit(per_minute=60, monotonic=clock)
    for number in range(MOST_BUCKETS - 1):
        limit.take(str(number))
    clock.now += 60.0
    assert [limit.take(KEY) for _ in range(61)][-1] == 1
    limit.take("one more")
    assert limit.take(KEY) == 1
