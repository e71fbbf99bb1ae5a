"""A real disk of a few megabytes that fills up: nothing is lost, and the reserve lets erase."""

import contextlib
import json
import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import httpx
import pytest

from service.jobs.storage_identity import SCOPE as STORAGE_SCOPE
from tests.integration.service.fake_pipeline import scripted_image
from tests.integration.service.harness import (
    REPOSITORY,
    REQUEST,
    Machine,
    Service,
    eventually,
    pids_noted,
    running_service,
    said_of_view,
)
from tests.small_disk import BYTES_PER_MB, SmallDisk, small_disk

RESERVE_MB = 10
SHORT = 5 * BYTES_PER_MB
"""Free, and less than the reserve."""

RESULTS = {"sweep_interval_s": 0.3, "worker_processes": 1, "min_free_disk_mb": RESERVE_MB}
JSON = {"Content-Type": "application/json"}


@contextlib.contextmanager
def mounted_below(folder: Path) -> Iterator[SmallDisk]:
    try:
        with small_disk(folder / "disk", megabytes=60) as mounted:
            yield mounted
    except PermissionError as error:
        pytest.skip(f"no disk can be mounted here ({error})")


@pytest.fixture
def disk(tmp_path: Path) -> Iterator[SmallDisk]:
    with mounted_below(tmp_path) as mounted:
        yield mounted


@pytest.fixture(scope="module")
def shared(tmp_path_factory: pytest.TempPathFactory) -> Iterator[tuple[SmallDisk, Service]]:
    """A service on a disk, the same for several tests."""
    with (
        mounted_below(tmp_path_factory.mktemp("shared")) as mounted,
        running_service(machine_on(mounted)) as service,
    ):
        yield mounted, service


@pytest.fixture
def on_disk(shared: tuple[SmallDisk, Service]) -> Iterator[tuple[SmallDisk, Service]]:
    """That service, with room on its disk; nothing waits or is kept afterwards."""
    mounted, service = shared
    yield mounted, service
    mounted.clear()
    for job in service.client.get("/v1/fits").raise_for_status().json()["fits"]:
        service.client.delete(job["links"]["self"]).raise_for_status()


def machine_on(disk: SmallDisk, **changes: object) -> Machine:
    return Machine(disk.folder / "data", settings=RESULTS | changes)


def large(number: int, **script: object) -> dict[str, object]:
    """A picture of two megabytes."""
    return {"number": number, "padding": "." * 2_000_000} | script


def upload(service: Service, content: bytes) -> httpx.Response:
    return service.client.post("/v1/images", files={"image": ("p.png", content, "image/png")})


def assert_no_room(answer: httpx.Response) -> None:
    assert answer.status_code == 507, answer.text
    assert answer.headers["content-type"] == "application/problem+json"
    assert int(answer.headers["Retry-After"]) > 0
    problem: dict[str, Any] = answer.json()
    assert (problem["type"], problem["code"]) == ("/problems/insufficient-storage", "disk-full")
    assert problem["remedy"]


def blobs_of(disk: SmallDisk) -> set[Path]:
    """What lies there of jobs and pictures; folders may be erased meanwhile."""
    folders = os.walk(disk.folder / "data" / "blobs")
    return {
        Path(folder) / name
        for folder, _, names in folders
        if Path(folder).name != STORAGE_SCOPE
        for name in names
    }


def test_short_of_room_everything_that_stores_is_refused_and_the_rest_works(
    on_disk: tuple[SmallDisk, Service],
):
    disk, service = on_disk
    key = {"Idempotency-Key": "before"}
    fit = service.post(headers=key).headers["Location"]
    assert service.ended(fit)["state"] == "succeeded"
    product = service.client.post(f"{fit}/products", json={"kind": "pose"})
    service.ended(product.headers["Location"])
    image = upload(service, scripted_image({"kept": True})).json()["id"]
    kept = blobs_of(disk)

    disk.leave(SHORT)
    ready = service.client.get("/healthz/ready")
    assert (ready.status_code, ready.json()["code"]) == (503, "disk-full")
    assert_no_room(service.post())
    by_id = json.dumps(REQUEST | said_of_view(image_id=image))
    assert_no_room(service.client.post("/v1/fits", content=by_id, headers=JSON))
    assert_no_room(upload(service, scripted_image({"new": True})))
    other = {"kind": "pose", "pose": "sitting"}
    assert_no_room(service.client.post(f"{fit}/products", json=other))
    assert service.client.post(f"{fit}/products", json={"kind": "pose"}).status_code == 200
    assert blobs_of(disk) == kept

    assert service.post(headers=key).headers["Location"] == fit
    assert upload(service, scripted_image({"kept": True})).status_code == 200
    assert service.client.get(f"{fit}/result").status_code == 200
    metrics = service.client.get("/metrics").text
    free = float(metrics.partition("\nmaquette_disk_free_bytes ")[2].split()[0])
    # The database's own files may have grown or shrunk since.
    assert free == pytest.approx(disk.free_bytes, abs=BYTES_PER_MB)
    assert free < RESERVE_MB * BYTES_PER_MB

    disk.clear()
    assert service.ended(service.submit())["state"] == "succeeded"
    assert service.client.get("/healthz/ready").status_code == 200


def test_what_would_break_into_the_reserve_is_refused(on_disk: tuple[SmallDisk, Service]):
    disk, service = on_disk
    disk.leave((RESERVE_MB + 1) * BYTES_PER_MB)
    assert service.post({"small": True}).status_code == 202
    assert_no_room(service.post(large(1)))


def test_an_upload_that_finds_no_room_on_its_way_is_refused(
    disk: SmallDisk, embedded: Machine, monkeypatch: pytest.MonkeyPatch
):
    # Sockets of fork servers lie there too, whose paths must be short.
    short = Path(tempfile.mkdtemp(dir="/tmp")) / "disk"
    short.symlink_to(disk.folder)
    monkeypatch.setenv("TMPDIR", str(short))
    with running_service(embedded, api_only=True) as service:
        assert service.post(large(1)).status_code == 202
        disk.leave(0)
        assert_no_room(service.post(large(2)))
        assert_no_room(upload(service, scripted_image(large(3))))
        disk.clear()
        assert service.post(large(2)).status_code == 202


def test_what_waits_is_begun_when_there_is_room_again(
    on_disk: tuple[SmallDisk, Service], tmp_path: Path
):
    note, gate = tmp_path / "pids", tmp_path / "gate"
    disk, service = on_disk
    running = service.submit({"gate": str(gate), "note_pid": str(note)})
    waiting = [service.submit({"number": number}) for number in range(3)]
    eventually(lambda: pids_noted(note), what="the fit runs")
    disk.leave(SHORT)
    gate.touch()
    assert service.ended(running)["state"] == "succeeded"
    assert {service.state(path) for path in waiting} == {"queued"}
    disk.clear()
    for path in waiting:
        job = service.ended(path)
        assert (job["state"], job["attempt"]) == ("succeeded", 1)


def test_what_expires_while_the_disk_is_short_makes_room(disk: SmallDisk):
    with running_service(machine_on(disk)) as service:
        paths = [service.submit(large(number)) for number in range(5)]
        for path in paths:
            service.ended(path)
        disk.leave(SHORT)
        for path in paths:
            service.machine.rewrite(path, expires_at=time.time())
        eventually(lambda: not blobs_of(disk), what="all is erased")
        assert {service.client.get(path).status_code for path in paths} == {410}


def test_while_the_disk_is_short_a_key_is_revoked_and_a_service_started_can_erase(disk: SmallDisk):
    machine = machine_on(disk)
    with running_service(machine) as service:
        path = service.submit(large(1))
        service.ended(path)
        key = keys(machine, "create", "somebody").stdout.strip()
    disk.leave(SHORT)
    revoked = keys(machine, "revoke", key.split("_")[1])
    assert revoked.returncode == 0, revoked.stderr
    with running_service(machine, api_only=True) as service:
        assert service.client.get(f"{path}/result").status_code == 200
        assert service.client.delete(path).status_code == 204
        # The picture's two megabytes, less what the database wrote meanwhile.
        assert disk.free_bytes > 1_500_000


def keys(machine: Machine, *arguments: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, "-m", "service.cli", "keys", *arguments],
        cwd=REPOSITORY,
        env=machine.environment(),
        capture_output=True,
        text=True,
        check=False,
    )
