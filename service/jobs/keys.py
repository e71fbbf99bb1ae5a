"""API keys: who may send requests, and as which tenant.

A key is 256 random bits; only its SHA-256 is stored, which suffices for a secret that cannot be
guessed. It is shown once, when it is created.
"""

import hashlib
import re
import secrets
import time
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Final

import sqlalchemy as sa

from service.jobs.database import available
from service.jobs.tables import API_KEYS

MARK: Final = "mq"
TENANT_NAME: Final = re.compile(r"[a-z0-9][a-z0-9-]{0,62}")


@dataclass(frozen=True, slots=True, kw_only=True)
class ApiKey:
    """A stored key; times are seconds since the epoch."""

    id: str
    tenant: str
    secret_hash: str
    created_at: float
    revoked_at: float | None


class KeyRing:
    """The keys in the database."""

    def __init__(self, database: sa.Engine) -> None:
        self._database = database

    @available
    def create(self, tenant: str) -> str:
        """Create a key and return it; it cannot be shown again.

        Raises
        ------
        ValueError
            If the tenant's name is invalid.
        """
        if TENANT_NAME.fullmatch(tenant) is None:
            message = "a tenant is named by up to 63 small letters, digits and hyphens"
            raise ValueError(message)
        identity = secrets.token_hex(4)
        key = f"{MARK}_{identity}_{secrets.token_urlsafe(32)}"
        with self._database.begin() as connection:
            connection.execute(
                sa.insert(API_KEYS).values(
                    id=identity,
                    tenant=tenant,
                    secret_hash=hash_key(key),
                    created_at=time.time(),
                )
            )
        return key

    @available
    def revoke(self, identity: str) -> bool:
        """Revoke a key, within seconds in every process; returns whether it was valid."""
        with self._database.begin() as connection:
            return (
                connection.execute(
                    sa.update(API_KEYS)
                    .where(API_KEYS.c.id == identity, API_KEYS.c.revoked_at.is_(None))
                    .values(revoked_at=time.time())
                ).rowcount
                > 0
            )

    @available
    def all_keys(self) -> Sequence[ApiKey]:
        """Return all keys, oldest first."""
        query = sa.select(API_KEYS).order_by(API_KEYS.c.created_at)
        with self._database.connect() as connection:
            rows: list[dict[str, Any]] = [{**row} for row in connection.execute(query).mappings()]
        return [ApiKey(**row) for row in rows]


def hash_key(key: str) -> str:
    """Return what is stored in place of a key."""
    return hashlib.sha256(key.encode()).hexdigest()
