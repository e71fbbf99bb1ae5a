"""Rate limit of an API key: a bucket for each in this process, which fills evenly.

Each API process limits by itself. Where several of them must allow no more than one, the proxy
before them limits.
"""

import math
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

MOST_BUCKETS: Final = 10_000
"""Full buckets are dropped beyond this: a key that is met again has a full one anyway."""


@dataclass(slots=True)
class _Bucket:
    """``requests`` that may pass, as of ``filled_at``."""

    requests: float
    filled_at: float


class RateLimit:
    """At most ``per_minute`` requests per minute and key, in bursts of up to as many.

    For use from a single event loop.
    """

    def __init__(self, *, per_minute: int, monotonic: Callable[[], float] = time.monotonic) -> None:
        self._capacity = float(per_minute)
        self._per_second = per_minute / 60.0
        self._monotonic = monotonic
        self._buckets: dict[str, _Bucket] = {}

    def take(self, key: str) -> int:
        """Let a request pass and return 0, or return the whole seconds until one may pass."""
        now = self._monotonic()
        if len(self._buckets) >= MOST_BUCKETS:
            self._drop_full(now)
        bucket = self._buckets.setdefault(key, _Bucket(self._capacity, now))
        self._fill(bucket, now)
        if bucket.requests < 1.0:
            return max(1, math.ceil((1.0 - bucket.requests) / self._per_second))
        bucket.requests -= 1.0
        return 0

    def _fill(self, bucket: _Bucket, now: float) -> None:
        passed_s = now - bucket.filled_at
        bucket.requests = min(self._capacity, bucket.requests + passed_s * self._per_second)
        bucket.filled_at = now

    def _drop_full(self, now: float) -> None:
        for key, bucket in list(self._buckets.items()):
            self._fill(bucket, now)
            if bucket.requests >= self._capacity:
                del self._buckets[key]
