"""The arithmetic of a token bucket, which fills at a constant rate."""

import math
from dataclasses import dataclass


@dataclass(slots=True)
class TokenBucket:
    """``tokens`` as of ``filled_at``, in seconds of any clock that does not jump."""

    capacity: float
    per_second: float
    tokens: float
    filled_at: float

    def fill(self, now: float) -> None:
        """Add the tokens that have accrued since."""
        self.tokens = min(self.capacity, self.tokens + (now - self.filled_at) * self.per_second)
        self.filled_at = now

    @property
    def wait_s(self) -> float:
        """Seconds from the last filling until there is a token; 0 if there is one."""
        return max(0.0, (1.0 - self.tokens) / self.per_second)

    @property
    def is_full(self) -> bool:
        """Whether it was full at the last filling."""
        return self.tokens >= self.capacity


def whole_seconds(wait_s: float) -> int:
    """How long a caller is told to wait: whole seconds, at least one."""
    return max(1, math.ceil(wait_s))
