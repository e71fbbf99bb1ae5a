"""Tokens for browsers: made with a key, and what may be asked with one."""

import time
from collections.abc import Callable
from datetime import UTC, datetime
from typing import Final

from anyio import CapacityLimiter, to_thread
from fastapi import APIRouter, Request
from starlette.concurrency import run_in_threadpool

from api_schemas.problems import problem
from api_schemas.tokens import NewToken, TokenRequest
from service.api.context import Context
from service.api.json_bodies import json_body, read_json
from service.api.problems import ProblemError, documented
from service.api.sandbox import check_label
from service.engine.browser_token_port import BrowserToken, BrowserTokens, NewBrowserToken
from service.engine.keys import hash_key

ROUTER: Final = APIRouter(prefix="/v1/tokens", tags=["tokens"])

ALLOWED: Final = (
    "/v1/fits",
    "/v1/scans",
    "/v1/images",
    "/v1/points",
    "/v1/checks",
    "/v1/initial-poses",
    "/v1/bodies",
    "/v1/body-models",
)
"""What may be asked with a token: jobs and pictures, of which it sees its own, and what is answered
at once. Whatever else there is or will be needs a key."""

REFRESH_S: Final = 5.0
"""Within this time at the latest a token is refused whose key was revoked."""

MOST_REMEMBERED: Final = 10_000

LOOKED_UP_AT_ONCE: Final = 2
"""Unknown tokens cost a query each; however many are sent, they take no more connections."""


def is_allowed(path: str) -> bool:
    """Whether a path may be asked for with a token."""
    return any(path == each or path.startswith(f"{each}/") for each in ALLOWED)


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


@ROUTER.post(
    "",
    status_code=201,
    response_model=NewToken,
    summary="Make a token for a browser",
    openapi_extra=json_body(TokenRequest),
    responses=documented(
        "malformed-request",
        "payload-too-large",
        "unsupported-media-type",
        "invalid-request",
        "not-found",
        "not-ready",
        "internal-error",
    ),
)
async def make_token(request: Request, context: Context) -> NewToken:
    """Make a token that a browser may use in place of the key, so that the key stays on a server.

    With a token one may upload pictures, have proposals, checks and bodies, and make fits, scans
    and what is derived from them, as many jobs as it is good for. It sees its own jobs and pictures
    alone. These belong to the key's tenant, who sees them too; requests count as those of the
    key. It ends at its `expires_at`, or within seconds when the key is revoked. It may neither make
    tokens, list people, nor ask for notices (`webhook`).

    Where the service asks for no keys there is nothing that a token could stand for, and the answer
    is a 404 whose code is `authentication-off`.
    """
    asked = await read_json(request, TokenRequest)
    if context.key_id is None:
        raise ProblemError(
            problem(
                "not-found",
                code="authentication-off",
                detail="This service asks for no keys, so there are no tokens.",
                remedy="Send requests without a token, or have MAQUETTE_AUTHENTICATION=keys set.",
            )
        )
    check_label(context, asked.label)
    new = NewBrowserToken(
        key_id=context.key_id,
        tenant=context.tenant,
        lifetime_s=asked.lifetime_s,
        jobs=asked.jobs,
        label=asked.label,
    )
    text, token = await run_in_threadpool(context.browser_tokens.create, new)
    return NewToken(
        id=token.id,
        token=text,
        expires_at=datetime.fromtimestamp(token.expires_at, UTC),
        jobs=token.jobs,
        label=token.label,
    )
