"""What a setting must be that is more than a number: folders, addresses, lists, a secret.

Each type checks one value by itself; its errors say what to write. An address is shown without its
secrets.
"""

import ipaddress
import re
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Annotated, Final
from urllib.parse import SplitResult, urlsplit

from pydantic import AfterValidator

from api_schemas.jobs import secret_key
from fitter.detection.weights import FILES

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


def split_list(text: str) -> tuple[str, ...]:
    """Read a list separated by commas."""
    return tuple(each.strip() for each in text.split(",") if each.strip())


def _that_passes(check: Callable[[str], object]) -> AfterValidator:
    def checked(text: str) -> str:
        check(text)
        return text

    return AfterValidator(checked)


def _each_passes(check: Callable[[str], None]) -> AfterValidator:
    def checked(text: str) -> str:
        for each in split_list(text):
            check(each)
        return text

    return AfterValidator(checked)


def _named(folder: Path) -> Path:
    if folder == Path():
        message = "name a folder, or unset it for the default"
        raise ValueError(message)
    return folder


def _holding(names: Sequence[str], remedy: str) -> AfterValidator:
    def checked(folder: Path) -> Path:
        for name in names:
            if not (folder / name).is_file():
                message = f"no {name} in {folder}: {remedy}"
                raise ValueError(message)
        return folder

    return AfterValidator(checked)


MODEL_FILES: Final = ("female.npz", "male.npz")
DETECTOR_FILES: Final = tuple(each.name for each in FILES)

NamedFolder = Annotated[Path, AfterValidator(_named)]
ModelFolder = Annotated[Path, _holding(MODEL_FILES, "train one, or copy the packaged one there")]
DetectorFolder = Annotated[
    Path,
    _holding(
        DETECTOR_FILES,
        "copy it there from the package mediapipe 0.10.21, or unset it where that is installed",
    ),
]
DatabaseUrl = Annotated[str, AfterValidator(read_database_url)]
BucketUrl = Annotated[str, _that_passes(check_bucket)]
WebhookSecret = Annotated[str, _that_passes(secret_key)]
Origins = Annotated[str, _each_passes(check_origin)]
HostNames = Annotated[str, _each_passes(check_host_name)]
