"""Short-lived tokens that browsers use in place of a key, made by the site that embeds the page.

A token is 256 random bits, as a key is, and only its SHA-256 is stored. It is valid until it
expires or its key is revoked. Jobs made with it belong to the tenant and outlive it.
"""

import secrets
import time
from collections.abc import Sequence
from typing import Any, Final

import sqlalchemy as sa

from api_schemas.tokens import IMAGES_OF_JOB
from service.engine.availability import available
from service.engine.browser_token_port import BrowserToken, NewBrowserToken, TokenStanding
from service.engine.keys import hash_key
from service.engine.tables import API_KEYS, BROWSER_TOKENS, IMAGES

MARK: Final = "mqt_"
"""What every token begins with, and no key."""


class StoredBrowserTokens:
    """The tokens in the database; see :class:`service.engine.browser_token_port.BrowserTokens`."""

    def __init__(self, database: sa.Engine) -> None:
        self._database = database

    @available
    def create(self, new: NewBrowserToken) -> tuple[str, BrowserToken]:
        """Make a token; its text cannot be had again."""
        identity = secrets.token_hex(8)
        text = f"{MARK}{identity}_{secrets.token_urlsafe(32)}"
        now = time.time()
        with self._database.begin() as connection:
            row = connection.execute(
                sa.insert(BROWSER_TOKENS)
                .values(
                    id=identity,
                    key_id=new.key_id,
                    tenant=new.tenant,
                    label=new.label,
                    secret_hash=hash_key(text),
                    created_at=now,
                    expires_at=now + new.lifetime_s,
                    jobs=new.jobs,
                    jobs_left=new.jobs,
                )
                .returning(BROWSER_TOKENS)
            ).one()
        return text, _record(row)

    @available
    def find(self, presented: str) -> BrowserToken | None:
        """Return the token with this text, unless it has expired or its key is revoked."""
        query = _valid(sa.select(BROWSER_TOKENS)).where(
            BROWSER_TOKENS.c.secret_hash == hash_key(presented)
        )
        with self._database.connect() as connection:
            row = connection.execute(query).one_or_none()
        return None if row is None else _record(row)

    @available
    def tokens(
        self, tenant: str, *, limit: int, before: tuple[float, str] | None
    ) -> Sequence[TokenStanding]:
        """Return a tenant's valid tokens, newest first."""
        query = (
            _standing(tenant)
            .order_by(BROWSER_TOKENS.c.created_at.desc(), BROWSER_TOKENS.c.id.desc())
            .limit(limit)
        )
        if before is not None:
            place = sa.tuple_(BROWSER_TOKENS.c.created_at, BROWSER_TOKENS.c.id)
            query = query.where(place < sa.tuple_(*map(sa.literal, before)))
        with self._database.connect() as connection:
            return [_standing_of(row) for row in connection.execute(query)]

    @available
    def token(self, tenant: str, identity: str) -> TokenStanding | None:
        """Return a tenant's valid token, if there is one with this id."""
        query = _standing(tenant).where(BROWSER_TOKENS.c.id == identity)
        with self._database.connect() as connection:
            row = connection.execute(query).one_or_none()
        return None if row is None else _standing_of(row)

    @available
    def revoke(self, tenant: str, identity: str) -> bool:
        """Forget a token, so that it is refused within seconds; returns whether it was valid."""
        with self._database.begin() as connection:
            valid = connection.execute(
                _valid(sa.select(BROWSER_TOKENS.c.id)).where(
                    BROWSER_TOKENS.c.tenant == tenant, BROWSER_TOKENS.c.id == identity
                )
            ).one_or_none()
            if valid is None:
                return False
            gone = sa.delete(BROWSER_TOKENS).where(BROWSER_TOKENS.c.id == identity)
            return connection.execute(gone).rowcount > 0


def has_jobs_left(connection: sa.Connection, token_id: str) -> bool:
    """Whether a token may have one more job made."""
    left = connection.execute(
        sa.select(BROWSER_TOKENS.c.jobs_left).where(BROWSER_TOKENS.c.id == token_id)
    ).scalar_one_or_none()
    return left is not None and left > 0


def take_job(connection: sa.Connection, token_id: str) -> bool:
    """Take one of a token's jobs, if it has one left: only one of two racing callers gets it."""
    taken = connection.execute(
        sa.update(BROWSER_TOKENS)
        .where(BROWSER_TOKENS.c.id == token_id, BROWSER_TOKENS.c.jobs_left > 0)
        .values(jobs_left=BROWSER_TOKENS.c.jobs_left - 1)
    )
    return taken.rowcount > 0


def images_of_token(connection: sa.Connection, token_id: str) -> tuple[int, int]:
    """How many pictures are kept with a token, and how many may be.

    Within a transaction that writes, no other has the same answer before this one ends.
    """
    most = connection.execute(
        sa.select(BROWSER_TOKENS.c.jobs * IMAGES_OF_JOB)
        .where(BROWSER_TOKENS.c.id == token_id)
        .with_for_update()
    ).scalar_one_or_none()
    kept = connection.execute(
        sa.select(sa.func.count()).where(
            IMAGES.c.token_id == token_id, IMAGES.c.expires_at > time.time()
        )
    ).scalar_one()
    return kept, most or 0


def drop_expired_tokens(connection: sa.Connection, now: float) -> None:
    """Forget the tokens whose time is over."""
    connection.execute(sa.delete(BROWSER_TOKENS).where(BROWSER_TOKENS.c.expires_at <= now))


def _valid(query: sa.Select[tuple[Any, ...]]) -> sa.Select[tuple[Any, ...]]:
    """Of tokens those that are neither expired nor of a revoked key."""
    return query.join(API_KEYS, API_KEYS.c.id == BROWSER_TOKENS.c.key_id).where(
        BROWSER_TOKENS.c.expires_at > time.time(), API_KEYS.c.revoked_at.is_(None)
    )


def _standing(tenant: str) -> sa.Select[tuple[Any, ...]]:
    images = (
        sa.select(sa.func.count())
        .where(
            IMAGES.c.tenant == tenant,
            IMAGES.c.token_id == BROWSER_TOKENS.c.id,
            IMAGES.c.expires_at > time.time(),
        )
        .scalar_subquery()
    )
    columns = sa.select(BROWSER_TOKENS, images.label("images"))
    return _valid(columns).where(BROWSER_TOKENS.c.tenant == tenant)


def _standing_of(row: sa.Row) -> TokenStanding:
    return TokenStanding(
        token=_record(row),
        created_at=row.created_at,
        jobs_left=row.jobs_left,
        images=row.images,
    )


def _record(row: sa.Row) -> BrowserToken:
    return BrowserToken(
        id=row.id,
        key_id=row.key_id,
        tenant=row.tenant,
        jobs=row.jobs,
        label=row.label,
        expires_at=row.expires_at,
    )
