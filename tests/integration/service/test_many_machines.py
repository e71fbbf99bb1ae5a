"""Hosts that have a database and a bucket in common, and nothing else."""

import contextlib
import subprocess
from collections.abc import Iterator
from pathlib import Path

import psycopg
import pytest

from service.jobs.storage_identity import SCOPE as STORAGE_SCOPE
from tests.integration.service.fake_pipeline import scripted_image
from tests.integration.service.fake_processes import command
from tests.integration.service.harness import (
    REPOSITORY,
    Machine,
    Service,
    eventually,
    is_running,
    pids_noted,
    running_service,
)
from tests.object_storage import ObjectStorage
from tests.postgres import fresh_database

JOBS = 5

RENAMED = ("unshare", "--uts", "--map-root-user", "sh", "-c", 'hostname "$0" && exec "$@"')
"""Runs a command with a host name of its own: to the others it is on another machine."""


@pytest.fixture
def database_url() -> Iterator[str]:
    with contextlib.ExitStack() as stack:
        try:
            url = stack.enter_context(fresh_database())
        except psycopg.OperationalError as error:
            pytest.skip(f"no Postgres answers ({error})")
        yield url


@contextlib.contextmanager
def worker_on_another_host(machine: Machine, name: str) -> Iterator[subprocess.Popen[bytes]]:
    process = subprocess.Popen(
        [*RENAMED, name, *command("worker")],
        cwd=REPOSITORY,
        env=machine.environment(),
        stdin=subprocess.PIPE,
    )
    try:
        yield process
    finally:
        process.kill()
        process.wait()
        assert process.stdin is not None
        process.stdin.close()


def same_host(pid: int, other: int) -> bool:
    """Say whether a process runs and sees the same host name as another."""
    try:
        names = {Path(f"/proc/{each}/ns/uts").readlink() for each in (pid, other)}
    except FileNotFoundError:
        return False
    return is_running(pid) and len(names) == 1


def all_alive(service: Service, *workers: subprocess.Popen[bytes]) -> bool:
    ended = [worker.returncode for worker in workers if worker.poll() is not None]
    assert not ended, f"workers ended at their start: {ended}"
    return service.client.get("/healthz/ready").json().get("workers", 0) == len(workers)


def artifact(service: Service, job: dict, name: str) -> bytes:
    result = service.client.get(job["links"]["result"]).raise_for_status().json()
    assert name in {entry["name"] for entry in result["files"]}
    path = f"/v1/fits/{job['id']}/files/{name}"
    return service.client.get(path).raise_for_status().content


def test_a_host_takes_over_from_one_that_is_gone(
    storage: ObjectStorage, database_url: str, tmp_path: Path
):
    if subprocess.run([*RENAMED, "other", "true"], check=False, capture_output=True).returncode:
        pytest.skip("host names cannot be unshared here")
    shared = {**storage.settings, "worker_processes": 2, "dead_after_s": 6.0}
    front, left, right = (
        Machine(tmp_path / name, database_url, shared) for name in ("front", "left", "right")
    )
    note, gate = tmp_path / "pids", tmp_path / "gate"
    with contextlib.ExitStack() as stack:
        service = stack.enter_context(running_service(front, api_only=True))
        doomed = stack.enter_context(worker_on_another_host(left, "left"))
        other = stack.enter_context(worker_on_another_host(right, "right"))
        eventually(lambda: all_alive(service, doomed, other), what="both workers ready")
        scripts = [
            {"gate": str(gate), "note_pid": str(note), "number": number} for number in range(JOBS)
        ]
        paths = [service.submit(script) for script in scripts]
        eventually(
            lambda: any(same_host(pid, doomed.pid) for pid in pids_noted(note)),
            what="a fit on the host that is to go",
        )
        doomed.kill()
        gate.touch()
        jobs = [service.ended(path) for path in paths]
        assert [job["state"] for job in jobs] == ["succeeded"] * JOBS
        assert sum(job["attempt"] for job in jobs) > JOBS, "nothing was taken over"
        for script, job in zip(scripts, jobs, strict=True):
            assert artifact(service, job, "views/0/overlay.png") == scripted_image(script)
        for job in jobs:
            assert any(job["id"] in key for key in storage.object_names())
            assert service.client.delete(f"/v1/fits/{job['id']}").status_code == 204
        # A crowded machine makes one that lives silent too: it erases what it stored in vain.
        eventually(
            lambda: all(STORAGE_SCOPE in key for key in storage.object_names()),
            what="nothing is left in the bucket",
        )
    kept = [path for host in (front, left, right) for path in host.data_dir.rglob("*")]
    assert kept == []
