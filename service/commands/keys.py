"""``maquette keys create | list | revoke``."""

import sys
from datetime import UTC, datetime

from service.jobs.database import open_database, prepare_database
from service.jobs.keys import KeyRing, Role
from service.process.data_folder import prepare_data_folder
from service.settings import Settings


def create_key(settings: Settings, *, tenant: str, role: Role) -> int:
    """Create a key and print it, alone and only this once."""
    ring = _open(settings)
    try:
        key = ring.create(tenant, role)
    except ValueError as error:
        print(f"maquette keys: {error}.", file=sys.stderr)
        return 2
    print(key)
    print("Keep it: only its hash is stored, and it is not shown again.", file=sys.stderr)
    return 0


def list_keys(settings: Settings) -> int:
    """Print every key's id, tenant, role, dates and last use."""
    for key in _open(settings).all_keys():
        used = "no use known" if key.used_at is None else f"used {_minute(key.used_at)}"
        revoked = "" if key.revoked_at is None else f" revoked {_day(key.revoked_at)}"
        print(f"{key.id} {key.tenant} {key.role} created {_day(key.created_at)} {used}{revoked}")
    return 0


def revoke_key(settings: Settings, *, identity: str) -> int:
    """Revoke a key by its id, the part between the underscores."""
    if not _open(settings).revoke(identity):
        print(f"maquette keys: no key {identity} is in use.", file=sys.stderr)
        return 2
    return 0


def _open(settings: Settings) -> KeyRing:
    prepare_data_folder(settings)
    # It must be possible to revoke a key on a full disk too.
    prepare_database(settings.system_database_url)
    return KeyRing(open_database(settings.system_database_url, connections=1))


def _minute(seconds: float) -> str:
    return datetime.fromtimestamp(seconds, UTC).strftime("%Y-%m-%dT%H:%MZ")


def _day(seconds: float) -> str:
    return datetime.fromtimestamp(seconds, UTC).strftime("%Y-%m-%d")
