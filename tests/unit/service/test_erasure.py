"""Erasing behind a record that is gone, while the storage is away."""

from pathlib import Path

import pytest

from service.api.problems import ProblemError
from service.api.storage import erase_blobs
from service.jobs.blobs import BlobsUnavailableError
from service.jobs.blobs_local import LocalBlobStore


class Storage(LocalBlobStore):
    def __init__(self, *, is_away: bool) -> None:
        super().__init__(Path("/nowhere"))
        self.is_away = is_away
        self.erased: list[str] = []

    def erase(self, scope: str) -> None:
        if self.is_away:
            raise BlobsUnavailableError
        self.erased.append(scope)


def test_every_scope_is_erased():
    storage = Storage(is_away=False)
    erase_blobs(storage, ["a", "b"])
    assert storage.erased == ["a", "b"]


def test_a_storage_that_is_away_is_said_to_be_and_what_becomes_of_the_files():
    with pytest.raises(ProblemError) as refused:
        erase_blobs(Storage(is_away=True), ["a"])
    told = refused.value.problem
    assert (told.status, told.code) == (503, "storage-unavailable")
    assert "erased once that is back" in told.detail
