import hashlib
import os
import signal
import stat
import subprocess
import sys

import pytest

from service.jobs.blobs import BlobDamagedError, BlobMissingError, StorageFullError
from service.jobs.blobs_local import LocalBlobStore

KILLED_WHILE_WRITING = """
import os, pathlib, signal, sys
from service.jobs.blobs_local import LocalBlobStore
os.fsync = lambda _: os.kill(os.getpid(), signal.SIGKILL)
LocalBlobStore(pathlib.Path(sys.argv[1])).put("job-1", b"picture")
"""


@pytest.fixture(params=["nameless files", "named ones"], autouse=True)
def file_system(request, monkeypatch):
    """Once as most file systems are, once as one without nameless files answers."""
    if request.param == "named ones":
        monkeypatch.setattr("os.O_TMPFILE", os.O_DIRECTORY)


def test_a_blob_is_named_by_its_content_and_read_back(tmp_path):
    blobs = LocalBlobStore(tmp_path)
    digest = blobs.put("job-1", b"picture")
    assert digest == hashlib.sha256(b"picture").hexdigest()
    assert blobs.get("job-1", digest) == b"picture"


def test_a_bit_that_flipped_on_the_disk_is_found_when_the_blob_is_read(tmp_path):
    blobs = LocalBlobStore(tmp_path)
    digest = blobs.put("job-1", b"picture")
    file = tmp_path / "jo" / "job-1" / digest
    file.write_bytes(b"pictuse")
    with pytest.raises(BlobDamagedError, match=digest):
        blobs.get("job-1", digest)


def test_storing_the_same_content_twice_leaves_one_file(tmp_path):
    blobs = LocalBlobStore(tmp_path)
    digest = blobs.put("job-1", b"picture")
    assert blobs.put("job-1", b"picture") == digest
    assert [path.name for path in (tmp_path / "jo" / "job-1").iterdir()] == [digest]


def test_several_are_stored_with_their_names_in_order(tmp_path):
    blobs = LocalBlobStore(tmp_path)
    contents = [b"body", b"overlay", b"body"]
    names = blobs.put_all("job-1", contents)
    assert names == [hashlib.sha256(content).hexdigest() for content in contents]
    assert [blobs.get("job-1", name) for name in names] == contents


def test_all_files_reach_the_disk_before_their_folder_does(tmp_path, monkeypatch):
    synced: list[bool] = []
    monkeypatch.setattr(
        "os.fsync", lambda handle: synced.append(stat.S_ISDIR(os.fstat(handle).st_mode))
    )
    LocalBlobStore(tmp_path).put_all("job-1", [b"body", b"overlay"])
    assert synced == [False, False, True]


def test_erasing_a_scope_leaves_other_scopes_with_the_same_content(tmp_path):
    blobs = LocalBlobStore(tmp_path)
    digest = blobs.put("job-1", b"picture")
    blobs.put("job-2", b"picture")
    blobs.erase("job-1")
    with pytest.raises(BlobMissingError):
        blobs.get("job-1", digest)
    assert blobs.get("job-2", digest) == b"picture"


def test_erasing_what_is_not_there_is_fine(tmp_path):
    LocalBlobStore(tmp_path).erase("job-1")


def test_a_failed_write_leaves_no_temporary_file(tmp_path, monkeypatch):
    def full_disk(_: int) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("os.fsync", full_disk)
    with pytest.raises(StorageFullError, match="No space"):
        LocalBlobStore(tmp_path).put("job-1", b"picture")
    assert list((tmp_path / "jo" / "job-1").iterdir()) == []


def test_a_writer_that_is_killed_leaves_nothing(tmp_path):
    process = subprocess.run([sys.executable, "-c", KILLED_WHILE_WRITING, str(tmp_path)])
    assert process.returncode == -signal.SIGKILL
    assert list((tmp_path / "jo" / "job-1").iterdir()) == []
