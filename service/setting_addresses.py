"""Addresses among the settings: what they may be, and how they are shown without their secrets."""

import ipaddress
import re
from typing import Final
from urllib.parse import SplitResult, urlsplit

POSTGRES: Final = "postgresql"
POSTGRES_NAMES: Final = (POSTGRES, "postgres", "postgresql+psycopg")
"""What the scheme of a Postgres database is called; all mean the first."""

BUCKET: Final = re.compile(r"[A-Za-z0-9][A-Za-z0-9._-]{1,253}[A-Za-z0-9]")
"""Names that some server takes: old buckets of Amazon's are longer, or have capitals and _."""

NOT_SHOWN: Final = "(not shown)"


def read_database_url(url: str) -> str:
    """Return the address of a Postgres database as ``postgresql://...``.

    Raises
    ------
    ValueError
        If it is none; the message says what to write.
    """
    parts = _parts(url)
    if parts is None:
        message = (
            "it cannot be read: write postgresql://USER:PASSWORD@HOST:PORT/NAME, and in user and "
            "password / as %2F, @ as %40, : as %3A"
        )
        raise ValueError(message)
    if parts.scheme not in POSTGRES_NAMES:
        message = (
            "only Postgres is known: write postgresql://USER:PASSWORD@HOST:PORT/NAME, or unset it "
            "for SQLite in the data folder"
        )
        raise ValueError(message)
    return POSTGRES + url[len(parts.scheme) :]


def check_web_address(url: str) -> None:
    """Raise ValueError unless this is the address of a web server."""
    parts = _parts(url)
    if parts is None or parts.scheme not in ("http", "https") or not parts.hostname:
        message = "it is no web address: write scheme, host and port, as in https://host:4318"
        raise ValueError(message)


def check_origin(origin: str) -> None:
    """Raise ValueError if this is not scheme, host and port of a web page, and nothing else."""
    parts = urlsplit(origin)
    if parts.scheme not in ("http", "https") or origin != f"{parts.scheme}://{parts.netloc}":
        message = f"{origin!r} is no origin; write scheme, host and port, as in https://host"
        raise ValueError(message)


def check_bucket(url: str) -> None:
    """Raise ValueError unless this is the address of a bucket that can exist."""
    parts = _parts(url)
    if parts is None or parts.scheme != "s3" or not parts.netloc or parts.query or parts.fragment:
        message = "write it as s3://bucket or s3://bucket/prefix"
        raise ValueError(message)
    if not BUCKET.fullmatch(parts.netloc) or ".." in parts.netloc:
        message = (
            f"no bucket can be named {parts.netloc!r}: names have 3 to 63 lower-case letters, "
            "digits, - and ., with a letter or digit at both ends"
        )
        raise ValueError(message)


def check_host_name(host: str) -> None:
    """Raise ValueError if this is more than a name or an IP address."""
    if re.search(r"[/@\s]", host) or re.search(r"^[^:]*:[^:]*$", host):
        message = f"{host!r} is no host: write its name or address alone, without scheme or port"
        raise ValueError(message)


def is_loopback(host: str) -> bool:
    """Say whether an address, or the name ``localhost``, is reached from this machine only."""
    try:
        return ipaddress.ip_address(host.strip("[]")).is_loopback
    except ValueError:
        return host == "localhost"


def without_secrets(url: str) -> str:
    """Write an address without password and query; nothing of one that cannot be read."""
    parts = _parts(url)
    if parts is None or "://" not in url:
        return NOT_SHOWN
    user, at, host = parts.netloc.rpartition("@")
    name, colon, _ = user.partition(":")
    hidden = f"{name}:***" if colon else name
    return f"{parts.scheme}://{hidden}{at}{host}{parts.path}"


def _parts(url: str) -> SplitResult | None:
    try:
        parts = urlsplit(url)
        # Only now it is looked at, and may be no number.
        _ = parts.port
    except ValueError:
        return None
    return parts
