"""How often one API key may ask: a bucket of tokens that fills evenly."""

import math
import time
from collections.abc import Callable
from dataclasses import dataclass


@dataclass(slots=True)
class _Bucket:
    tokens: float
    filled_at: float


class RateLimit:
    """At most ``per_minute`` requests a minute and key, in this process; bursts of as many."""

    def __init__(self, *, per_minute: int, monotonic: Callable[[], float] = time.monotonic) -> None:
        self._capacity = float(per_minute)
        self._per_second = per_minute / 60.0
        self._monotonic = monotonic
        self._buckets: dict[str, _Bucket] = {}

    def take(self, key: str) -> int:
        """Take a token; returns 0, or the whole seconds until there is one."""
        now = self._monotonic()
        bucket = self._buckets.setdefault(key, _Bucket(self._capacity, now))
        bucket.tokens = min(
            self._capacity, bucket.tokens + (now - bucket.filled_at) * self._per_second
        )
        bucket.filled_at = now
        if bucket.tokens < 1.0:
            return max(1, math.ceil((1.0 - bucket.tokens) / self._per_second))
        bucket.tokens -= 1.0
        return 0
