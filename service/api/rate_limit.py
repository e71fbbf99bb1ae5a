"""Rate limit of an API key, by token buckets that all API processes share.

The bucket of a key is shared (:mod:`service.engine.token_port`). A process takes several tokens at
a time from it and spends them in memory, so that few requests cost an exchange. In addition each
process keeps a bucket of its own for what it has let pass: a request that this one refuses never
passes, and it alone counts while the shared one is unreachable or slow to answer. What passed
meanwhile is taken from the shared one afterwards.
"""

import asyncio
import logging
import math
import time
from collections.abc import AsyncIterator, Callable
from contextlib import asynccontextmanager, suppress
from dataclasses import dataclass
from functools import partial
from typing import Final

from anyio import CapacityLimiter, to_thread

from service.engine.port import EngineUnavailableError
from service.engine.token_port import SharedTokens

LOG: Final = logging.getLogger(__name__)

ALLOTMENTS: Final = 20
"""An allotment is this share of the capacity: what a process may hold, out of reach for others."""

UNSPENT_S: Final = 5.0
"""Tokens of a key that has sent no request for this long are given back."""

PATIENCE_S: Final = 1.0
"""Requests wait no longer than this for an exchange; it continues, and counts when it is done."""

RETRY_AWAY_S: Final = 1.0
"""Shared buckets that could not be reached are tried again after this time."""

EXCHANGES_AT_ONCE: Final = 4
"""Threads and connections that exchanges may occupy, however slow the database is."""


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


@dataclass(slots=True)
class _Account:
    """What this process knows about a key; times are by its own clock."""

    own: TokenBucket
    met_at: float
    refused_until: float
    held: int = 0
    unpaid: int = 0
    waiting: int = 0
    exchange: asyncio.Task[None] | None = None
    is_late: bool = False


class RateLimit:
    """At most ``per_minute`` requests per minute and key, in bursts of up to as many.

    For use from a single event loop, which the exchanges do not block.
    """

    def __init__(
        self,
        shared: SharedTokens,
        *,
        per_minute: int,
        patience_s: float = PATIENCE_S,
        monotonic: Callable[[], float] = time.monotonic,
    ) -> None:
        self._shared = shared
        self._capacity = float(per_minute)
        self._per_second = per_minute / 60.0
        self._allotment = max(1, per_minute // ALLOTMENTS)
        self._patience_s = patience_s
        self._monotonic = monotonic
        self._accounts: dict[str, _Account] = {}
        self._exchanging = CapacityLimiter(EXCHANGES_AT_ONCE)
        self._away_until: float | None = None

    async def take(self, key: str) -> int:
        """Take a token; returns 0, or the whole seconds until there is one."""
        account = self._account(key)
        account.waiting += 1
        try:
            while (retry_after_s := self._answer(account)) is None:
                # One exchange for all waiting requests.
                exchange = account.exchange or self._begin_exchange(key, account)
                done, _ = await asyncio.wait({exchange}, timeout=self._patience_s)
                if not done:
                    account.is_late = True
        finally:
            account.waiting -= 1
        return retry_after_s

    @asynccontextmanager
    async def giving_back(self) -> AsyncIterator[None]:
        """Give back what is unspent: from time to time, and all of it at the end."""
        regularly = asyncio.create_task(self._give_back_regularly())
        try:
            yield
        finally:
            regularly.cancel()
            with suppress(asyncio.CancelledError):
                await regularly
            await self.give_back(unspent_s=0.0)

    async def give_back(self, *, unspent_s: float = UNSPENT_S) -> None:
        """Give back the tokens of keys that have been idle for a while, and forget these keys."""
        now = self._monotonic()
        exchanges: list[asyncio.Task[None]] = []
        for key, account in list(self._accounts.items()):
            if account.waiting or account.exchange or now - account.met_at < unspent_s:
                continue
            account.own.fill(now)
            if account.held > 0:
                exchanges.append(self._begin_exchange(key, account))
            elif account.own.is_full and now >= account.refused_until:
                del self._accounts[key]
        if exchanges:
            await asyncio.wait(exchanges, timeout=self._patience_s)

    def _account(self, key: str) -> _Account:
        account = self._accounts.get(key)
        if account is None:
            now = self._monotonic()
            own = TokenBucket(self._capacity, self._per_second, self._capacity, now)
            account = self._accounts[key] = _Account(own, met_at=now, refused_until=now)
        return account

    def _answer(self, account: _Account) -> int | None:
        """Answer as :meth:`take` does; None if that needs an exchange."""
        now = self._monotonic()
        account.met_at = now
        account.own.fill(now)
        if account.own.wait_s > 0.0:
            return whole_seconds(account.own.wait_s)
        if account.held > 0:
            account.held -= 1
        elif now < account.refused_until:
            return whole_seconds(account.refused_until - now)
        elif not account.is_late and not self._is_away(now):
            return None
        else:
            account.unpaid += 1
        account.own.tokens -= 1.0
        return 0

    def _is_away(self, now: float) -> bool:
        return self._away_until is not None and now < self._away_until

    def _begin_exchange(self, key: str, account: _Account) -> asyncio.Task[None]:
        account.exchange = asyncio.create_task(self._exchange(key, account))
        return account.exchange

    async def _exchange(self, key: str, account: _Account) -> None:
        """Bring the account up to date; never raises, whatever happens to the shared bucket."""
        returned, account.held = account.held, 0
        # The rest has been refilled meanwhile, in the shared bucket too.
        account.unpaid = min(account.unpaid, int(self._capacity - account.own.tokens))
        # What waiting requests spend at once is not held by the process.
        needed = max(self._allotment, account.waiting) if account.waiting else 0
        wanted = account.unpaid + needed
        exchange = partial(self._shared.exchange, key, returned=returned, wanted=wanted)
        try:
            grant = await to_thread.run_sync(exchange, limiter=self._exchanging)
        except EngineUnavailableError as error:
            self._note_away(error)
            return
        except Exception as error:
            LOG.exception("Tokens cannot be exchanged.")
            self._note_away(error)
            return
        finally:
            account.exchange = None
            account.is_late = False
        if self._away_until is not None:
            self._away_until = None
            LOG.info("The limit of requests is shared with the other processes again.")
        paid = min(grant.tokens, account.unpaid)
        account.unpaid -= paid
        account.held += grant.tokens - paid
        if grant.tokens < wanted:
            account.refused_until = self._monotonic() + whole_seconds(grant.wait_s)

    def _note_away(self, error: Exception) -> None:
        if self._away_until is None:
            cause = error.__cause__ or error
            LOG.warning(
                "The database is not available (%s); this process limits requests by itself.",
                getattr(cause, "orig", cause),
            )
        self._away_until = self._monotonic() + RETRY_AWAY_S

    async def _give_back_regularly(self) -> None:
        while True:
            await asyncio.sleep(UNSPENT_S)
            await self.give_back()
