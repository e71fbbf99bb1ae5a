"""``maquette keys create | list | revoke``."""

import argparse
import sys
from datetime import UTC, datetime
from pathlib import Path

from service.jobs.database import open_database, prepare_database
from service.jobs.keys import KeyRing
from service.process.data_folder import prepare_data_folder
from service.settings import Settings
from service.startup import UNUSABLE, given, run_command


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """An action, and what it needs."""
    actions = parser.add_subparsers(required=True, metavar="ACTION")
    create = actions.add_parser("create", help="make a key and print it, once")
    create.add_argument("tenant", help="whose jobs it opens; made by being named")
    listing = actions.add_parser("list", help="list all keys")
    revoke = actions.add_parser("revoke", help="make a key useless")
    revoke.add_argument("id", help="the part of the key between the underscores")
    for action, act in ((create, _create), (listing, _list), (revoke, _revoke)):
        action.add_argument("--data-dir", type=Path, help="that of the service")
        action.set_defaults(act=act)


def run(parsed: argparse.Namespace) -> int:
    """Do what is asked with the keys of the service of these settings."""
    return run_command(
        "keys",
        lambda settings: parsed.act(_opened(settings), parsed),
        given(parsed, "data_dir"),
    )


def _create(ring: KeyRing, parsed: argparse.Namespace) -> int:
    """Print the key alone and only this once."""
    try:
        key = ring.create(parsed.tenant)
    except ValueError as error:
        print(f"maquette keys: {error}.", file=sys.stderr)
        return UNUSABLE
    print(key)
    print("Keep it: only its hash is stored, and it is not shown again.", file=sys.stderr)
    return 0


def _list(ring: KeyRing, _: argparse.Namespace) -> int:
    """Print every key's id, tenant and dates."""
    for key in ring.all_keys():
        revoked = "" if key.revoked_at is None else f" revoked {_day(key.revoked_at)}"
        print(f"{key.id} {key.tenant} created {_day(key.created_at)}{revoked}")
    return 0


def _revoke(ring: KeyRing, parsed: argparse.Namespace) -> int:
    if not ring.revoke(parsed.id):
        print(f"maquette keys: no key {parsed.id} is in use.", file=sys.stderr)
        return UNUSABLE
    return 0


def _opened(settings: Settings) -> KeyRing:
    prepare_data_folder(settings)
    # It must be possible to revoke a key on a full disk too.
    prepare_database(settings.system_database_url)
    return KeyRing(open_database(settings.system_database_url, connections=1))


def _day(seconds: float) -> str:
    return datetime.fromtimestamp(seconds, UTC).strftime("%Y-%m-%d")
