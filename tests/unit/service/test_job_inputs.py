"""What a job is made of comes into its scope file by file, or not at all, and after its place."""

import asyncio
import threading
import time
from pathlib import Path
from types import SimpleNamespace
from typing import Any, cast

import pytest
from anyio import CapacityLimiter

from service.api.acceptance import accept
from service.api.context import ApiContext
from service.api.job_inputs import COPIED_AT_ONCE, Copy, File, Inputs, store_inputs
from service.api.problems import ProblemError
from service.blobs import BlobsUnavailableError
from service.blobs.local import LocalBlobStore
from service.engine.port import StoredBlob, Submission, SubmitOutcome
from service.engine.tenant_jobs import TenantJobs
from service.process.data_folder import Disk

JOB, FIT, OTHER = "0job", "1fit", "2fit"


class WatchedBlobs(LocalBlobStore):
    """Notes what it is asked for, in order, and how many files read were not yet written."""

    def __init__(self, root: Path) -> None:
        super().__init__(root)
        self.asked: list[tuple[str, str]] = []
        self.held = 0
        self.most_held = 0
        self.full_after: int | None = None
        self._lock = threading.Lock()

    def get(self, scope: str, name: str) -> bytes:
        content = super().get(scope, name)
        self.asked.append(("get", content.decode()))
        with self._lock:
            self.held += 1
            self.most_held = max(self.most_held, self.held)
        time.sleep(0.02)
        return content

    def put(self, scope: str, content: bytes) -> str:
        self.asked.append(("put", content.decode()))
        if self.full_after is not None and len(self.asked) > self.full_after:
            raise BlobsUnavailableError
        with self._lock:
            self.held -= content.decode() in (FIT, OTHER)
        return super().put(scope, content)

    def names(self, scope: str) -> set[str]:
        return {path.name for path in (self.root / scope[:2] / scope).glob("*")}


@pytest.fixture
def blobs(tmp_path: Path) -> WatchedBlobs:
    return WatchedBlobs(tmp_path)


def context_of(blobs: WatchedBlobs) -> ApiContext:
    copying = CapacityLimiter(COPIED_AT_ONCE)
    return cast(
        "ApiContext",
        SimpleNamespace(
            blobs=blobs,
            disk=Disk(None, reserve_bytes=1),
            copying=copying,
            request_id=None,
        ),
    )


def copies(blobs: WatchedBlobs) -> Inputs:
    """One file that was sent and one each of two fits."""
    files: dict[str, File | Copy] = {"sent": File(content=b"sent", media_type="text/plain")}
    for scope in (FIT, OTHER):
        digest = LocalBlobStore(blobs.root).put(scope, scope.encode())
        files[scope] = Copy(scope=scope, blob=StoredBlob(digest=digest, media_type="image/png"))
    return Inputs(kind="pose", options=b"{}", files=files, webhook=None)


class Jobs:
    """Has a place for every job, or for none."""

    def __init__(self, reserved: SubmitOutcome = SubmitOutcome.ACCEPTED) -> None:
        self.reserved = reserved

    def reserve(self, job_id: str, key: object) -> Submission:
        return Submission(outcome=self.reserved, job=None)

    def submit(self, job: Any) -> Submission:
        return Submission(outcome=SubmitOutcome.ACCEPTED, job=job)


def accept_one(context: ApiContext, inputs: Inputs, jobs: Jobs) -> Any:
    return accept(context, cast("TenantJobs", jobs), inputs, key=None)


def test_each_file_is_put_before_the_next_is_read(blobs: WatchedBlobs):
    stored = store_inputs(context_of(blobs), JOB, copies(blobs))
    assert blobs.asked == [
        ("put", "{}"),
        ("put", "sent"),
        ("get", FIT),
        ("put", FIT),
        ("get", OTHER),
        ("put", OTHER),
    ]
    digests = {stored.options.digest, *(blob.digest for blob in stored.files.values())}
    assert blobs.names(JOB) == digests
    assert stored.files[FIT].media_type == "image/png"


def test_nothing_is_left_where_a_fit_is_erased_meanwhile(blobs: WatchedBlobs):
    inputs = copies(blobs)
    blobs.erase(OTHER)
    with pytest.raises(ProblemError) as caught:
        store_inputs(context_of(blobs), JOB, inputs)
    assert caught.value.problem.status == 404
    assert ("put", FIT) in blobs.asked
    assert not blobs.names(JOB)


def test_nothing_is_left_where_the_storage_fails_midway(blobs: WatchedBlobs):
    inputs = copies(blobs)
    blobs.full_after = 4
    with pytest.raises(BlobsUnavailableError):
        store_inputs(context_of(blobs), JOB, inputs)
    assert ("put", FIT) in blobs.asked
    assert not blobs.names(JOB)


def test_no_copy_is_made_where_there_is_no_room(blobs: WatchedBlobs):
    inputs = copies(blobs)
    with pytest.raises(ProblemError) as caught:
        asyncio.run(accept_one(context_of(blobs), inputs, Jobs(SubmitOutcome.QUEUE_FULL)))
    assert caught.value.problem.status == 503
    assert not blobs.asked


def test_the_copies_of_few_jobs_are_made_at_once(blobs: WatchedBlobs):
    inputs = copies(blobs)

    async def many() -> list[Any]:
        context = context_of(blobs)
        return await asyncio.gather(*(accept_one(context, inputs, Jobs()) for _ in range(8)))

    assert len(asyncio.run(many())) == 8
    assert 1 <= blobs.most_held <= COPIED_AT_ONCE
