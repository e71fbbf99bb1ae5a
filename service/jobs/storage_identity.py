"""A database and the storage of its blobs belong together: neither is used with another.

The database names a storage by a number, a fact, and the storage holds that number as a blob in a
scope of its own. Two services on one database whose folders or buckets differ would lose the jobs
that the other one accepted: the second is refused when it starts.
"""

import contextlib
import hashlib
import uuid
from collections.abc import Iterator
from typing import Final
from urllib.parse import urlsplit

import sqlalchemy as sa

from service.jobs.blobs import (
    BlobMissingError,
    BlobStore,
    StorageRefusedError,
    StorageUnusableError,
    retry_while_storage_is_away,
    setting_of_storage,
)
from service.jobs.blobs_local import LocalBlobStore
from service.jobs.database import (
    locked,
    opened,
    read_fact,
    retry_while_database_is_away,
    write_fact,
)
from service.settings import SettingError, Settings

STORAGE_FACT: Final = "storage"
OFFERED_FACT: Final = "storage_offered"
SCOPE: Final = "storage-of"
"""Scope of the number; scopes of jobs have other names, and only those are ever erased."""


def open_blob_store(settings: Settings) -> BlobStore:
    """Open the store named by ``blob_url``: ``s3://bucket/prefix``, or the data folder if unset.

    Raises
    ------
    SettingError
        If S3 is asked for and its client is not installed.
    """
    if settings.blob_url is None:
        return LocalBlobStore(settings.blob_dir)
    url = urlsplit(settings.blob_url)
    try:
        # Only here: the client is an extra, and takes a third of a second to load.
        from service.jobs.blobs_s3 import S3BlobStore
    except ImportError as error:
        message = "S3 needs the client; install it with: pip install 'maquette[s3]'"
        raise SettingError(message, name="blob_url", value=settings.blob_url) from error
    return S3BlobStore(bucket=url.netloc, prefix=url.path)


@retry_while_database_is_away
@retry_while_storage_is_away
def take_storage(settings: Settings, blobs: BlobStore, *, adopt: bool = False) -> None:
    """Take the storage for the database's from now on, unless it has one: then check it.

    A new database has none, so the first process that starts decides; its folder or bucket is made
    unless it is there, and must not be that of another database. With ``adopt`` the storage takes
    the place of the one that the database had. The tables must be there. Waits for a database or a
    storage that does not answer.

    Raises
    ------
    StorageUnusableError
        If it is another database's, or refuses what it is asked for.
    """
    named = setting_of_storage(settings)
    with opened(settings.system_database_url) as engine:
        with engine.connect() as connection:
            number = read_fact(connection, STORAGE_FACT)
        if number is None or adopt:
            with _refusals(named):
                blobs.prepare()
        if number is None:
            number = _decide(engine, blobs, named, adopt=adopt)
    if adopt:
        with _refusals(named):
            blobs.put(SCOPE, number.encode())
    _check(blobs, number, named)


def _decide(engine: sa.Engine, blobs: BlobStore, named: str, *, adopt: bool) -> str:
    """Return the database's number, which the storage holds if nobody was quicker."""
    with locked(engine) as connection:
        offered = read_fact(connection, OFFERED_FACT) or uuid.uuid4().hex
        # Before the storage knows it: whoever dies in between knows it again.
        write_fact(connection, OFFERED_FACT, offered)
    with locked(engine) as connection, _refusals(named):
        number = read_fact(connection, STORAGE_FACT)
        if number is None:
            number = offered
            if not adopt and not _holds(blobs, offered) and SCOPE in blobs.scopes():
                message = (
                    f"{named}: this is the storage of another database, and the one given is new "
                    "or was emptied; give the service that database back or another storage, or, "
                    "if it is lost, run maquette serve --adopt-storage once, which has erased "
                    "after a day what the new one does not know"
                )
                raise StorageUnusableError(message)
            blobs.put(SCOPE, number.encode())
            write_fact(connection, STORAGE_FACT, number)
    return number


def _holds(blobs: BlobStore, number: str) -> bool:
    try:
        blobs.get(SCOPE, hashlib.sha256(number.encode()).hexdigest())
    except BlobMissingError:
        return False
    return True


def _check(blobs: BlobStore, number: str, named: str) -> None:
    with _refusals(named):
        is_its_own = _holds(blobs, number)
    if not is_its_own:
        message = (
            f"{named}: this is not the storage of the database, which has its pictures and "
            "results elsewhere; give all API processes and workers of a database the same "
            "storage, or, if the former one is lost or was moved here in part, run "
            "maquette serve --adopt-storage once"
        )
        raise StorageUnusableError(message)


@contextlib.contextmanager
def _refusals(named: str) -> Iterator[None]:
    """Say which setting it is that no waiting makes right."""
    try:
        yield
    except StorageRefusedError as error:
        message = (
            f"{named}: {error}, and waiting does not help; correct the name of the bucket, its "
            "region or the credentials, or have the rights given"
        )
        raise StorageUnusableError(message) from error
