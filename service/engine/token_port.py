"""What the API asks of the store of rate limits that all API processes share."""

from dataclasses import dataclass
from typing import Protocol


@dataclass(frozen=True, slots=True, kw_only=True)
class Grant:
    """Tokens taken from a shared bucket, and the seconds until it has one more."""

    tokens: int
    wait_s: float


class SharedTokens(Protocol):
    """A bucket for each key, which fills evenly; a bucket that nobody has met is full."""

    def exchange(self, key: str, *, returned: int, wanted: int) -> Grant:
        """Give ``returned`` tokens back and take up to ``wanted``: as many as there are.

        Raises
        ------
        service.engine.port.EngineUnavailableError
            If the buckets are out of reach; nothing was taken.
        """
        ...
