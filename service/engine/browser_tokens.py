"""Tokens that browsers use in place of a key, for minutes, made by the site that embeds the page.

A token is 256 random bits, as a key is, and only its SHA-256 is stored. It counts as long as its
key is not revoked. What it has made stays when it has expired, and belongs to the tenant.
"""

import secrets
import time
from typing import Final

import sqlalchemy as sa

from service.engine.availability import available
from service.engine.browser_token_port import BrowserToken, NewBrowserToken
from service.engine.keys import hash_key
from service.engine.tables import API_KEYS, BROWSER_TOKENS

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
        query = (
            sa.select(BROWSER_TOKENS)
            .join(API_KEYS, API_KEYS.c.id == BROWSER_TOKENS.c.key_id)
            .where(
                BROWSER_TOKENS.c.secret_hash == hash_key(presented),
                BROWSER_TOKENS.c.expires_at > time.time(),
                API_KEYS.c.revoked_at.is_(None),
            )
        )
        with self._database.connect() as connection:
            row = connection.execute(query).one_or_none()
        return None if row is None else _record(row)


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


def drop_expired_tokens(connection: sa.Connection) -> None:
    """Forget the tokens whose time is over."""
    connection.execute(sa.delete(BROWSER_TOKENS).where(BROWSER_TOKENS.c.expires_at <= time.time()))


def _record(row: sa.Row) -> BrowserToken:
    return BrowserToken(
        id=row.id,
        key_id=row.key_id,
        tenant=row.tenant,
        jobs=row.jobs,
        label=row.label,
        expires_at=row.expires_at,
    )
