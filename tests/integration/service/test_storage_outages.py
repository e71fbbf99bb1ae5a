"""An object storage that refuses connections or answers 503: callers are told, jobs wait for it."""

from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.chaos.outages.storage_door import Manner, StorageDoor, storage_door
from tests.integration.service.harness import (
    Machine,
    Service,
    eventually,
    is_running,
    pids_noted,
    running_service,
)
from tests.object_storage import CREDENTIALS, ObjectStorage, running_object_storage

JSON = "application/problem+json"


@pytest.fixture
def storage(monkeypatch: pytest.MonkeyPatch) -> Iterator[ObjectStorage]:
    for name, value in CREDENTIALS.items():
        monkeypatch.setenv(name, value)
    with running_object_storage() as running:
        place = {"LocationConstraint": running.settings["s3_region"]}
        running.client.create_bucket(Bucket=running.bucket, CreateBucketConfiguration=place)
        yield running


@pytest.fixture
def door(storage: ObjectStorage) -> Iterator[StorageDoor]:
    with storage_door(storage.endpoint_url) as kept:
        yield kept


@pytest.mark.parametrize("manner", Manner)
def test_a_storage_that_is_away_is_told_and_waited_for(
    storage: ObjectStorage, door: StorageDoor, manner: Manner, tmp_path: Path
):
    note, gate = tmp_path / "pids", tmp_path / "gate"
    behind = {**storage.settings, "s3_endpoint_url": door.endpoint_url}
    with running_service(Machine(tmp_path / "data", settings=behind)) as service:
        ended = service.submit()
        service.ended(ended)
        running = service.submit({"gate": str(gate), "note_pid": str(note)})
        (pid,) = eventually(lambda: pids_noted(note), what="the fit runs")

        door.fail(manner)
        assert_refused_for_now(service, "POST", "/v1/fits")
        assert_refused_for_now(service, "GET", f"{ended}/result")
        assert_refused_for_now(service, "GET", "/healthz/ready")
        told = assert_refused_for_now(service, "DELETE", ended)
        assert "erased once that is back" in told
        assert service.client.get(ended).status_code == 404
        gate.touch()
        eventually(lambda: not is_running(pid), what="the fit is done")
        assert service.state(running) == "running"

        door.recover()
        job = service.ended(running)
        assert (job["state"], job["attempt"]) == ("succeeded", 1)
        assert service.client.get(f"{running}/result").status_code == 200


def assert_refused_for_now(service: Service, method: str, path: str) -> str:
    """Ask, and return what is told."""
    answer = service.post() if method == "POST" else service.client.request(method, path)
    assert answer.status_code == 503, answer.text
    assert answer.headers["content-type"] == JSON
    assert int(answer.headers["Retry-After"]) > 0
    assert answer.json()["code"] == "storage-unavailable"
    return answer.json()["detail"]
