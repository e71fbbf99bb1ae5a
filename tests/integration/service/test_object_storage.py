"""Blobs in S3-compatible storage, over real HTTP against an emulated server."""

import hashlib
import os
from collections.abc import Callable, Iterator
from typing import Any

import pytest
from botocore.client import BaseClient

from service.jobs.blobs import (
    BlobMissingError,
    BlobStore,
    BlobsUnavailableError,
)
from service.jobs.database import prepare_database
from service.jobs.storage_identity import open_blob_store, take_storage
from service.settings import Settings
from service.startup import run_command
from tests.object_storage import CREDENTIALS, REGION, ObjectStorage, running_object_storage


@pytest.fixture(scope="module")
def server() -> Iterator[ObjectStorage]:
    with running_object_storage() as running:
        yield running


@pytest.fixture
def _credentials(server: ObjectStorage, monkeypatch: pytest.MonkeyPatch) -> None:
    for name, value in CREDENTIALS.items():
        monkeypatch.setenv(name, value)
    monkeypatch.setenv("AWS_ENDPOINT_URL_S3", server.endpoint_url)
    monkeypatch.setenv("AWS_DEFAULT_REGION", REGION)


@pytest.fixture
def storage(server: ObjectStorage, request: pytest.FixtureRequest) -> ObjectStorage:
    """The server with a bucket for this test alone, not made yet."""
    name = hashlib.sha256(request.node.nodeid.encode()).hexdigest()[:12]
    return ObjectStorage(server.endpoint_url, f"test-{name}")


@pytest.fixture
def blobs(storage: ObjectStorage, _credentials: None) -> BlobStore:
    store = open_blob_store(Settings(blob_url=storage.blob_url))
    store.prepare()
    return store


def test_a_blob_is_an_object_below_the_prefix_named_by_its_content(blobs, storage):
    digest = blobs.put("job-1", b"picture")
    assert digest == hashlib.sha256(b"picture").hexdigest()
    assert blobs.get("job-1", digest) == b"picture"
    assert storage.object_names() == [f"blobs/job-1/{digest}"]


def test_erasing_a_scope_leaves_its_neighbours(blobs, storage):
    digest = blobs.put("job-1", b"picture")
    blobs.put("job-1", b"result")
    blobs.put("job-10", b"picture")
    assert sorted(blobs.scopes()) == ["job-1", "job-10"]
    blobs.erase("job-1")
    with pytest.raises(BlobMissingError):
        blobs.get("job-1", digest)
    assert list(blobs.scopes()) == ["job-10"]
    assert storage.object_names() == [f"blobs/job-10/{digest}"]


def test_more_objects_than_one_listing_holds_are_erased(blobs, storage, monkeypatch):
    monkeypatch.setattr("service.jobs.blobs_s3.LISTED_AT_ONCE", 2)
    for number in range(5):
        storage.client.put_object(Bucket=storage.bucket, Key=f"blobs/job-1/{number}", Body=b"")
    blobs.erase("job-1")
    assert storage.object_names() == []


def test_erasing_leaves_no_version_where_the_bucket_keeps_them(blobs, storage):
    storage.client.put_bucket_versioning(
        Bucket=storage.bucket, VersioningConfiguration={"Status": "Enabled"}
    )
    for _ in range(2):
        blobs.put("job-1", b"picture")
    blobs.erase("job-1")
    blobs.erase("job-1")
    left = storage.client.list_object_versions(Bucket=storage.bucket)
    assert "Versions" not in left
    assert "DeleteMarkers" not in left


def test_another_content_than_stored_is_not_taken_for_the_blob(blobs, storage):
    digest = blobs.put("job-1", b"picture")
    storage.client.put_object(Bucket=storage.bucket, Key=f"blobs/job-1/{digest}", Body=b"other")
    with pytest.raises(BlobsUnavailableError, match="another content"):
        blobs.get("job-1", digest)


def test_looking_whether_it_can_be_written_leaves_nothing(blobs, storage):
    blobs.check_writable()
    assert storage.object_names() == []


@pytest.mark.usefixtures("_credentials")
def test_a_bucket_that_is_not_there_is_said_so(storage):
    with pytest.raises(BlobsUnavailableError, match="NoSuchBucket"):
        open_blob_store(Settings(blob_url=storage.blob_url)).check_writable()


@pytest.mark.usefixtures("_credentials")
def test_a_server_that_is_not_there_is_said_so(monkeypatch):
    monkeypatch.setattr("service.jobs.blobs_s3.ATTEMPTS", 1)
    monkeypatch.setenv("AWS_ENDPOINT_URL_S3", "http://127.0.0.1:9")
    with pytest.raises(BlobsUnavailableError, match="cannot be reached"):
        open_blob_store(Settings(blob_url="s3://bucket")).check_writable()


@pytest.fixture
def settings(storage, _credentials, tmp_path) -> Settings:
    """Those of a database with tables, and a storage that nobody has made."""
    settings = Settings(data_dir=tmp_path, blob_url=storage.blob_url)
    prepare_database(settings.system_database_url)
    return settings


def take(settings: Settings) -> None:
    take_storage(settings, open_blob_store(settings))


def test_the_first_to_take_a_storage_makes_the_bucket(settings, storage):
    for _ in range(2):
        take(settings)
    place = storage.client.get_bucket_location(Bucket=storage.bucket)
    assert place["LocationConstraint"] == REGION


def test_a_bucket_that_is_there_is_not_made_again(settings, blobs, monkeypatch):
    monkeypatch.setattr(
        "botocore.client.BaseClient._make_api_call",
        without("CreateBucket", BaseClient._make_api_call),
    )
    take(settings)


def without(forbidden: str, call: Callable[..., Any]) -> Callable[..., Any]:
    """Calls of a client that may do one thing less."""

    def checked(client: BaseClient, operation: str, arguments: dict[str, Any]) -> Any:
        assert operation != forbidden
        return call(client, operation, arguments)

    return checked


def test_a_bucket_that_cannot_be_made_is_told_in_a_line(settings, monkeypatch, capsys):
    monkeypatch.setattr("service.jobs.blobs_s3.ATTEMPTS", 1)
    monkeypatch.setattr("service.process.retrying.RETRY_FOR_S", 0.0)
    monkeypatch.setenv("AWS_ENDPOINT_URL_S3", "http://127.0.0.1:9")
    assert run_command("serve", lambda _: take(settings)) == os.EX_UNAVAILABLE
    (line,) = capsys.readouterr().err.splitlines()
    assert "the storage is not available" in line
