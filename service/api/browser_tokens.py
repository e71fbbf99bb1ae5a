"""Tokens for browsers: made with a key, and what may be asked with one."""

from datetime import UTC, datetime
from typing import Annotated, Final

from fastapi import APIRouter, Path, Request, Response
from starlette.concurrency import run_in_threadpool

from api_schemas.problems import problem
from api_schemas.tokens import (
    IMAGES_OF_JOB,
    NewToken,
    Token,
    TokenId,
    TokenPage,
    TokenRequest,
)
from service.api.context import ApiContext, Context
from service.api.json_bodies import json_body, read_json
from service.api.listing import (
    Limit,
    cursor_of,
    cursor_pattern,
    cursor_query,
    page_of,
    read_cursor,
)
from service.api.problems import ProblemError, documented, not_found
from service.engine.browser_token_port import NewBrowserToken, TokenStanding

PATH: Final = "/v1/tokens"
ROUTER: Final = APIRouter(prefix=PATH, tags=["tokens"])

CURSOR: Final = cursor_pattern("[0-9a-f]{16}")

_UNKNOWN: Final = documented("not-found", "invalid-request", "not-ready", "internal-error")

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


def is_allowed(path: str) -> bool:
    """Whether a path may be asked for with a token."""
    return any(path == each or path.startswith(f"{each}/") for each in ALLOWED)


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
    and what is derived from them, as many jobs as it is good for. Of uploaded pictures it may have
    12 at a time for each of these jobs. It sees its own jobs and pictures alone. These belong to
    the key's tenant, who sees them too; requests count as those of the key. It ends at its
    `expires_at`, or within seconds when it or the key is revoked. It may neither make nor list
    tokens, nor ask for notices (`webhook`).

    Where the service asks for no keys there is nothing that a token could stand for, and the answer
    is a 404 whose code is `authentication-off`.
    """
    asked = await read_json(request, TokenRequest)
    key_id = _key_of(context)
    new = NewBrowserToken(
        key_id=key_id,
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


@ROUTER.get("", response_model=TokenPage, summary="List tokens, newest first", responses=_UNKNOWN)
def list_tokens(
    response: Response,
    context: Context,
    limit: Limit = 50,
    cursor: Annotated[str | None, cursor_query(CURSOR)] = None,
) -> TokenPage:
    """List the tenant's tokens that are valid, and what they have left.

    `next` and the Link header lead to the following page.
    """
    _key_of(context)
    found = context.browser_tokens.tokens(
        context.tenant, limit=limit + 1, before=read_cursor(CURSOR, cursor)
    )
    page, following = page_of(
        found,
        response,
        path=PATH,
        limit=limit,
        cursor=lambda last: cursor_of(last.created_at, last.token.id),
    )
    return TokenPage(tokens=tuple(map(_represent, page)), next=following)


@ROUTER.get("/{token_id}", response_model=Token, summary="Look at a token", responses=_UNKNOWN)
def get_token(token_id: Annotated[TokenId, Path()], context: Context) -> Token:
    """Return what a token is good for, and what it has left; those that have ended are gone."""
    _key_of(context)
    standing = context.browser_tokens.token(context.tenant, token_id)
    if standing is None:
        raise not_found(what="such token")
    return _represent(standing)


@ROUTER.delete("/{token_id}", status_code=204, summary="Revoke a token", responses=_UNKNOWN)
async def revoke_token(token_id: Annotated[TokenId, Path()], context: Context) -> Response:
    """End a token before its time: it is refused within five seconds.

    Jobs and pictures that were made with it stay, and belong to the tenant.
    """
    _key_of(context)
    if not await context.known_tokens.revoke(context.tenant, token_id):
        raise not_found(what="such token")
    return Response(status_code=204)


def _key_of(context: ApiContext) -> str:
    """The key that a request came with; 404 where the service asks for none."""
    if context.key_id is None:
        raise ProblemError(
            problem(
                "not-found",
                code="authentication-off",
                detail="This service asks for no keys, so there are no tokens.",
                remedy="Send requests without a token, or have MAQUETTE_AUTHENTICATION=keys set.",
            )
        )
    return context.key_id


def _represent(standing: TokenStanding) -> Token:
    token = standing.token
    return Token(
        id=token.id,
        key_id=token.key_id,
        label=token.label,
        created_at=datetime.fromtimestamp(standing.created_at, UTC),
        expires_at=datetime.fromtimestamp(token.expires_at, UTC),
        jobs=token.jobs,
        jobs_left=standing.jobs_left,
        images=standing.images,
        most_images=token.jobs * IMAGES_OF_JOB,
    )
