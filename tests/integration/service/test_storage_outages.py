"""An object storage that refuses or says nothing: callers are told at once, jobs wait for it."""

import time
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

from service.jobs.blobs_s3 import READ_TIMEOUT_S
from tests.chaos.outages.storage_door import Manner, StorageDoor, storage_door
from tests.integration.service.harness import (
    Machine,
    Service,
    eventually,
    is_running,
    pids_noted,
    running_service,
)
from tests.object_storage import ObjectStorage

PROBES = 60
"""More than the threads in which requests are answered."""

JSON = "application/problem+json"


@pytest.fixture
def storage(storage: ObjectStorage) -> ObjectStorage:
    """One whose bucket is there."""
    place = {"LocationConstraint": storage.settings["aws_default_region"]}
    storage.client.create_bucket(Bucket=storage.bucket, CreateBucketConfiguration=place)
    return storage


@pytest.fixture
def door(storage: ObjectStorage) -> Iterator[StorageDoor]:
    with storage_door(storage.endpoint_url) as kept:
        yield kept


@pytest.mark.parametrize("manner", [Manner.REFUSES, Manner.ANSWERS_503])
def test_a_storage_that_is_away_is_told_and_waited_for(
    storage: ObjectStorage, door: StorageDoor, manner: Manner, tmp_path: Path
):
    note, gate = tmp_path / "pids", tmp_path / "gate"
    behind = {**storage.settings, "aws_endpoint_url_s3": door.endpoint_url}
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


def test_a_storage_that_says_nothing_keeps_neither_probes_nor_other_routes_waiting(
    storage: ObjectStorage, door: StorageDoor, tmp_path: Path
):
    behind = {**storage.settings, "aws_endpoint_url_s3": door.endpoint_url}
    with running_service(Machine(tmp_path / "data", settings=behind)) as service:
        door.fail(Manner.SAYS_NOTHING)
        eventually(lambda: _silence_is_told(service), what="the storage is known to be silent")
        with ThreadPoolExecutor(PROBES) as probing:
            answers = list(probing.map(lambda _: _silence_is_told(service), range(PROBES)))
        assert all(answers)
        eventually(lambda: _is_refused_at_once(service), what="the storage is not waited for")
        began = time.monotonic()
        with ThreadPoolExecutor(PROBES) as posting:
            refused = [
                posting.submit(assert_refused_for_now, service, "POST", "/v1/fits")
                for _ in range(PROBES)
            ]
            assert service.client.get("/v1/fits").status_code == 200
        assert all(each.result() for each in refused)
        assert time.monotonic() - began < READ_TIMEOUT_S, "somebody waited for the storage"
        door.recover()
        eventually(
            lambda: service.client.get("/healthz/ready").status_code == 200, what="ready again"
        )


def _is_refused_at_once(service: Service) -> bool:
    began = time.monotonic()
    assert_refused_for_now(service, "POST", "/v1/fits")
    return time.monotonic() - began < READ_TIMEOUT_S


def _silence_is_told(service: Service) -> bool:
    """Whether a probe is answered before the storage is: what it says in the end is another."""
    answer = service.client.get("/healthz/ready")
    return answer.status_code == 503 and "storage has not answered" in answer.json()["detail"]


def assert_refused_for_now(service: Service, method: str, path: str) -> str:
    """Ask, and return what is told."""
    answer = service.post() if method == "POST" else service.client.request(method, path)
    assert answer.status_code == 503, answer.text
    assert answer.headers["content-type"] == JSON
    assert int(answer.headers["Retry-After"]) > 0
    assert answer.json()["code"] == "storage-unavailable"
    return answer.json()["detail"]
