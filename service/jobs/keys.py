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
from enum import StrEnum
from typing import Any, Final

import sqlalchemy as sa

from service.jobs.database import available
from service.jobs.tables import API_KEYS

MARK: Final = "mq"
TENANT_NAME: Final = re.compile(r"[a-z0-9][a-z0-9-]{0,62}")


class Role(StrEnum):
    """What a key gives access to: a tenant's fits, or the service's metrics and nothing else."""

    FITS = "fits"
    METRICS = "metrics"


@dataclass(frozen=True, slots=True, kw_only=True)
class ApiKey:
    """A stored key; times are seconds since the epoch."""

    id: str
    tenant: str
    role: Role
    secret_hash: str
    created_at: float
    revoked_at: float | None


class KeyRing:
    """The keys in the database."""

    def __init__(self, database: sa.Engine) -> None:
        self._database = database

    @available
    def create(self, tenant: str, role: Role = Role.FITS) -> str:
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
                    role=role.value,
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
            rows = connection.execute(query).mappings().all()
        return [_api_key(row) for row in rows]


def hash_key(key: str) -> str:
    """Return what is stored in place of a key."""
    return hashlib.sha256(key.encode()).hexdigest()


def _api_key(row: sa.RowMapping) -> ApiKey:
    values: dict[str, Any] = {**row, "role": Role(row["role"])}
    return ApiKey(**values)
