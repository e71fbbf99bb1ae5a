"""A database is not used with another folder or bucket than the one its jobs are in."""

import shutil
import threading
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest
import sqlalchemy as sa

from service.commands.serve import preflight
from service.jobs.blobs import StorageUnusableError
from service.jobs.blobs_local import LocalBlobStore
from service.jobs.database import open_database, prepare_database
from service.jobs.storage_identity import STORAGE_FACT, take_storage
from service.jobs.tables import FACTS
from service.settings import Settings
from tests.integration.service.harness import Machine, running_service
from tests.integration.service.test_refused_start import SERVE, WORKER, assert_refused, run
from tests.object_storage import ObjectStorage
from tests.postgres import fresh_database

AT_ONCE = 8


@pytest.fixture
def url(machine: Machine) -> str:
    """The address of a database with tables, which names no storage: as one of before."""
    address = machine.database_url or f"sqlite:///{machine.data_dir / 'maquette.sqlite'}"
    prepare_database(address)
    return address


def take(url: str, folder: Path, *, adopt: bool = False) -> None:
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
        take(url, ours)
    with pytest.raises(StorageUnusableError, match="MAQUETTE_DATA_DIR=/") as refused:
        take(url, theirs)
    assert "\n" not in str(refused.value)
    assert "maquette serve --adopt-storage" in str(refused.value)
    assert not theirs.exists()
    take(url, ours)


def test_a_copy_of_the_storage_is_the_storage_and_an_emptied_one_is_not(url: str, tmp_path: Path):
    take(url, tmp_path / "ours")
    shutil.copytree(tmp_path / "ours", tmp_path / "copy")
    take(url, tmp_path / "copy")
    shutil.rmtree(tmp_path / "ours")
    with pytest.raises(StorageUnusableError):
        take(url, tmp_path / "ours")


def test_a_storage_may_be_let_take_the_place_of_one_that_is_lost(url: str, tmp_path: Path):
    take(url, tmp_path / "lost")
    take(url, tmp_path / "new", adopt=True)
    take(url, tmp_path / "new")


def emptied(url: str) -> None:
    """Have the database forget its storage, as one that was made anew."""
    database = open_database(url, connections=1)
    with database.begin() as connection:
        connection.execute(sa.delete(FACTS))
    database.dispose()


def test_a_database_that_does_not_know_its_folder_is_refused_unless_it_is_said_to_be_lost(
    url: str, tmp_path: Path
):
    take(url, tmp_path)
    emptied(url)
    with pytest.raises(StorageUnusableError, match="storage of another database"):
        take(url, tmp_path)
    take(url, tmp_path, adopt=True)
    take(url, tmp_path)


def test_who_died_between_marking_the_storage_and_noting_it_takes_it_the_next_time(
    url: str, tmp_path: Path
):
    take(url, tmp_path)
    database = open_database(url, connections=1)
    with database.begin() as connection:
        connection.execute(sa.delete(FACTS).where(FACTS.c.name == STORAGE_FACT))
    database.dispose()
    take(url, tmp_path)


def test_of_several_that_start_at_once_with_storages_of_their_own_one_is_taken(
    url: str, tmp_path: Path
):
    together = threading.Barrier(AT_ONCE)

    def start(number: int) -> bool:
        together.wait()
        try:
            take(url, tmp_path / str(number))
        except StorageUnusableError:
            return False
        return True

    with ThreadPoolExecutor(AT_ONCE) as starting:
        assert sorted(starting.map(start, range(AT_ONCE))) == [False] * (AT_ONCE - 1) + [True]


@pytest.mark.parametrize("command", [SERVE, WORKER])
def test_no_command_starts_with_another_folder(command: tuple[str, ...], tmp_path: Path):
    with fresh_database() as database_url:
        with running_service(Machine(tmp_path / "ours", database_url), api_only=True):
            pass
        done = run(command, tmp_path / "theirs", database_url=database_url)
        line = assert_refused(done, naming=f"MAQUETTE_DATA_DIR={tmp_path / 'theirs'}:")
        assert "not the storage of the database" in line


def test_a_lost_folder_is_replaced_by_a_command(tmp_path: Path):
    with running_service(Machine(tmp_path), api_only=True):
        pass
    shutil.rmtree(tmp_path / "blobs")
    assert_refused(run(SERVE, tmp_path), naming=f"MAQUETTE_DATA_DIR={tmp_path}:")
    preflight(Settings(data_dir=tmp_path), adopt_storage=True)
    with running_service(Machine(tmp_path), api_only=True):
        pass


def test_another_bucket_or_prefix_is_refused(storage: ObjectStorage, tmp_path: Path):
    ours = storage.settings
    theirs = ours | {"blob_url": f"{ours['blob_url']}-of-others"}
    with running_service(Machine(tmp_path, settings=ours), api_only=True):
        pass
    for command in (SERVE, WORKER):
        done = run(command, tmp_path, **theirs)
        assert_refused(done, naming=f"MAQUETTE_BLOB_URL={theirs['blob_url']}:")


def test_what_the_storage_refuses_for_good_is_not_asked_for_again(
    storage: ObjectStorage, tmp_path: Path
):
    """Amazon's servers take no new bucket of a name so long, though some old ones have one."""
    wrong = storage.settings | {"blob_url": f"s3://{'a' * 70}"}
    line = assert_refused(run(WORKER, tmp_path, **wrong), naming="MAQUETTE_BLOB_URL=s3://aaa")
    assert "InvalidBucketName" in line
