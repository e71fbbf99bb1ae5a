"""What the API requires of the store of rate limits shared by all API processes."""

from dataclasses import dataclass
from typing import Protocol


@dataclass(frozen=True, slots=True, kw_only=True)
class Grant:
    """Tokens taken from a shared bucket, and the seconds until it has one more."""

    tokens: int
    wait_s: float


class SharedTokens(Protocol):
    """A bucket for each key, which fills at a constant rate; an unknown bucket is full."""

    def exchange(self, key: str, *, returned: int, wanted: int) -> Grant:
        """Give back ``returned`` tokens and take up to ``wanted``, as many as there are.

        Raises
        ------
        service.engine.port.EngineUnavailableError
            If the buckets cannot be reached; nothing was taken.
        """
        ...
