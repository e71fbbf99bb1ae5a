"""What the API requires of the short-lived tokens that browsers use in place of a key."""

from dataclasses import dataclass
from typing import Protocol


@dataclass(frozen=True, slots=True, kw_only=True)
class BrowserToken:
    """A token's record; ``expires_at`` is in seconds since the epoch.

    It acts for the tenant of the key that it was made with, and sees only jobs and pictures of its
    own. ``jobs`` is how many it may have made in all. Fits and scans get its ``label``, if any.
    """

    id: str
    key_id: str
    tenant: str
    jobs: int
    label: str | None
    expires_at: float


@dataclass(frozen=True, slots=True, kw_only=True)
class NewBrowserToken:
    """What a token is to be: for which key and tenant, for how long and how many jobs."""

    key_id: str
    tenant: str
    lifetime_s: int
    jobs: int
    label: str | None


class BrowserTokens(Protocol):
    """The tokens; its methods raise :class:`service.engine.port.EngineUnavailableError`."""

    def create(self, new: NewBrowserToken) -> tuple[str, BrowserToken]:
        """Make a token; its text cannot be had again."""
        ...

    def find(self, presented: str) -> BrowserToken | None:
        """Return the token with this text, unless it has expired or its key is revoked."""
        ...
