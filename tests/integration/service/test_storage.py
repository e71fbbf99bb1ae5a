"""Blobs in S3-compatible storage, and that a database keeps to the storage its jobs are in."""

import hashlib
import os
import shutil
import threading
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import pytest
import sqlalchemy as sa
from botocore.client import BaseClient

from service.commands.serve import preflight
from service.jobs.blobs import (
    BlobMissingError,
    BlobStore,
    BlobsUnavailableError,
    StorageUnusableError,
)
from service.jobs.blobs_local import LocalBlobStore
from service.jobs.database import open_database, prepare_database
from service.jobs.storage_identity import STORAGE_FACT, open_blob_store, take_storage
from service.jobs.tables import FACTS
from service.settings import Settings
from service.startup import run_command
from tests.integration.service.harness import Machine
from tests.integration.service.test_refused_start import SERVE, WORKER, assert_refused, run
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


AT_ONCE = 8


@pytest.fixture
def url(machine: Machine) -> str:
    """The address of a database with tables, which names no storage: as one of before."""
    address = machine.database_url or f"sqlite:///{machine.data_dir / 'maquette.sqlite'}"
    prepare_database(address)
    return address


def take_folder(url: str, folder: Path, *, adopt: bool = False) -> None:
    if url.startswith("sqlite"):
        settings = Settings(data_dir=Path(url.removeprefix("sqlite:///")).parent)
    else:
        settings = Settings(data_dir=folder, database_url=url)
    take_storage(settings, LocalBlobStore(folder), adopt=adopt)


def test_the_first_to_start_decides_and_whoever_has_another_storage_is_refused(
    url: str, tmp_path: Path
):
    ours, theirs = tmp_path / "ours", tmp_path / "theirs"
    for _ in range(2):
        take_folder(url, ours)
    with pytest.raises(StorageUnusableError, match="MAQUETTE_DATA_DIR=/") as refused:
        take_folder(url, theirs)
    assert "\n" not in str(refused.value)
    assert "maquette serve --adopt-storage" in str(refused.value)
    assert not theirs.exists()
    take_folder(url, ours)


def test_a_copy_of_the_storage_is_the_storage_and_an_emptied_one_is_not(url: str, tmp_path: Path):
    take_folder(url, tmp_path / "ours")
    shutil.copytree(tmp_path / "ours", tmp_path / "copy")
    take_folder(url, tmp_path / "copy")
    shutil.rmtree(tmp_path / "ours")
    with pytest.raises(StorageUnusableError):
        take_folder(url, tmp_path / "ours")


def test_a_storage_may_be_let_take_the_place_of_one_that_is_lost(url: str, tmp_path: Path):
    take_folder(url, tmp_path / "lost")
    take_folder(url, tmp_path / "new", adopt=True)
    take_folder(url, tmp_path / "new")


def emptied(url: str) -> None:
    """Have the database forget its storage, as one that was made anew."""
    database = open_database(url, connections=1)
    with database.begin() as connection:
        connection.execute(sa.delete(FACTS))
    database.dispose()


def test_a_database_that_does_not_know_its_folder_is_refused_unless_it_is_said_to_be_lost(
    url: str, tmp_path: Path
):
    take_folder(url, tmp_path)
    emptied(url)
    with pytest.raises(StorageUnusableError, match="storage of another database"):
        take_folder(url, tmp_path)
    take_folder(url, tmp_path, adopt=True)
    take_folder(url, tmp_path)


def test_who_died_between_marking_the_storage_and_noting_it_takes_it_the_next_time(
    url: str, tmp_path: Path
):
    take_folder(url, tmp_path)
    database = open_database(url, connections=1)
    with database.begin() as connection:
        connection.execute(sa.delete(FACTS).where(FACTS.c.name == STORAGE_FACT))
    database.dispose()
    take_folder(url, tmp_path)


def test_of_several_that_start_at_once_with_storages_of_their_own_one_is_taken(
    url: str, tmp_path: Path
):
    together = threading.Barrier(AT_ONCE)

    def start(number: int) -> bool:
        together.wait()
        try:
            take_folder(url, tmp_path / str(number))
        except StorageUnusableError:
            return False
        return True

    with ThreadPoolExecutor(AT_ONCE) as starting:
        assert sorted(starting.map(start, range(AT_ONCE))) == [False] * (AT_ONCE - 1) + [True]


def test_a_lost_folder_is_replaced_by_a_command(tmp_path: Path):
    settings = Settings(data_dir=tmp_path)
    preflight(settings)
    shutil.rmtree(tmp_path / "blobs")
    assert_refused(run(SERVE, tmp_path), naming=f"MAQUETTE_DATA_DIR={tmp_path}:")
    preflight(settings, adopt_storage=True)
    preflight(settings)


@pytest.mark.usefixtures("_credentials")
def test_another_bucket_or_prefix_is_refused(storage: ObjectStorage, tmp_path: Path):
    theirs = storage.settings | {"blob_url": f"{storage.blob_url}-of-others"}
    preflight(Settings(data_dir=tmp_path, blob_url=storage.blob_url))
    done = run(WORKER, tmp_path, **theirs)
    assert_refused(done, naming=f"MAQUETTE_BLOB_URL={theirs['blob_url']}:")


@pytest.mark.usefixtures("_credentials")
def test_what_the_storage_refuses_for_good_is_not_asked_for_again(
    storage: ObjectStorage, tmp_path: Path
):
    """Amazon's servers take no new bucket of a name so long, though some old ones have one."""
    wrong = storage.settings | {"blob_url": f"s3://{'a' * 70}"}
    line = assert_refused(run(WORKER, tmp_path, **wrong), naming="MAQUETTE_BLOB_URL=s3://aaa")
    assert "InvalidBucketName" in line
