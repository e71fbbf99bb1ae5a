"""What the API requires of the short-lived tokens that browsers use in place of a key."""

from collections.abc import Sequence
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
class TokenStanding:
    """What a token has left: ``jobs_left`` it may still have made, ``images`` are kept with it."""

    token: BrowserToken
    created_at: float
    jobs_left: int
    images: int


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

    def tokens(
        self, tenant: str, *, limit: int, before: tuple[float, str] | None
    ) -> Sequence[TokenStanding]:
        """Return a tenant's valid tokens, newest first, after the one ``before`` names."""
        ...

    def token(self, tenant: str, identity: str) -> TokenStanding | None:
        """Return a tenant's valid token, if there is one with this id."""
        ...

    def revoke(self, tenant: str, identity: str) -> bool:
        """Forget a token, so that it is refused within seconds; returns whether it was valid."""
        ...
