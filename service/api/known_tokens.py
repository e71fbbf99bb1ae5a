"""The browsers' tokens that are in use, remembered so that a request costs no query."""

import time
from collections.abc import Callable
from typing import Final

from anyio import CapacityLimiter, to_thread

from service.engine.browser_token_port import BrowserToken, BrowserTokens
from service.engine.keys import hash_key

REFRESH_S: Final = 5.0
"""Within this time at the latest a token is refused that was revoked, or whose key was."""

MOST_REMEMBERED: Final = 10_000

LOOKED_UP_AT_ONCE: Final = 2
"""Unknown tokens cost a query each; however many are sent, they take no more connections."""


class KnownTokens:
    """The valid tokens, each remembered for a few seconds."""

    def __init__(
        self, tokens: BrowserTokens, *, monotonic: Callable[[], float] = time.monotonic
    ) -> None:
        self._tokens = tokens
        self._monotonic = monotonic
        self._remembered: dict[str, tuple[float, BrowserToken]] = {}
        self._limiter = CapacityLimiter(LOOKED_UP_AT_ONCE)

    async def find(self, presented: str) -> BrowserToken | None:
        """Return the valid token that was presented; None if there is no such token.

        Raises
        ------
        EngineUnavailableError
            If the database is unavailable.
        """
        secret_hash = hash_key(presented)
        found_at, token = self._remembered.get(secret_hash, (0.0, None))
        if token is None or self._monotonic() - found_at >= REFRESH_S:
            self._remembered.pop(secret_hash, None)
            token = await to_thread.run_sync(self._tokens.find, presented, limiter=self._limiter)
            if token is not None:
                if len(self._remembered) >= MOST_REMEMBERED:
                    self._remembered.clear()
                self._remembered[secret_hash] = (self._monotonic(), token)
        return token if token is not None and token.expires_at > time.time() else None

    async def revoke(self, tenant: str, identity: str) -> bool:
        """Revoke a tenant's token, here at once; returns whether it was valid.

        Raises
        ------
        EngineUnavailableError
            If the database is unavailable.
        """
        was_valid = await to_thread.run_sync(self._tokens.revoke, tenant, identity)
        if was_valid:
            for secret_hash, (_, token) in list(self._remembered.items()):
                if token.id == identity:
                    del self._remembered[secret_hash]
        return was_valid
