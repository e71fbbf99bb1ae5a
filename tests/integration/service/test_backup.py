"""A backup by the runbook's commands, restored on an empty machine: all jobs are there."""

import contextlib
import os
import shlex
import shutil
import subprocess
import sys
from collections.abc import Iterator, Mapping
from pathlib import Path

import httpx
import psycopg
import pytest

from tests.integration.service.harness import REQUEST, Machine, Service, eventually, running_service
from tests.object_storage import ObjectStorage
from tests.postgres import fresh_database
from tests.readme import block

KEPT = 2
MAQUETTE = (sys.executable, "-m", "service.cli")
KEYS = {"authentication": "keys"}


@pytest.fixture
def databases() -> Iterator[tuple[str, str]]:
    """One to back up, and an empty one."""
    with contextlib.ExitStack() as stack:
        try:
            yield stack.enter_context(fresh_database()), stack.enter_context(fresh_database())
        except psycopg.OperationalError as error:
            pytest.skip(f"no Postgres answers ({error})")


def run_commands(name: str, folder: Path, **variables: str) -> None:
    """Run what the runbook shows under a name, where a stranger would."""
    program = "sqlite3" if "sqlite3" in block(name) else "pg_dump"
    if shutil.which(program) is None:
        pytest.skip(f"{program} is not installed")
    maquette = f'maquette() {{ {shlex.join(MAQUETTE)} "$@"; }}\n'
    done = subprocess.run(
        ["bash", "-euo", "pipefail", "-c", maquette + block(name)],
        cwd=folder,
        env=os.environ | variables,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr


def new_key(machine: Machine) -> str:
    done = subprocess.run(
        [*MAQUETTE, "keys", "create", "shop"],
        env=machine.environment(),
        capture_output=True,
        text=True,
        check=True,
    )
    return done.stdout.split()[-1]


def copy_objects(storage: ObjectStorage, *, to: str) -> None:
    """As a rule of the bucket would, or `aws s3 sync`."""
    storage.client.create_bucket(
        Bucket=to, CreateBucketConfiguration={"LocationConstraint": "eu-central-1"}
    )
    for name in storage.object_names():
        storage.client.copy({"Bucket": storage.bucket, "Key": name}, to, name)


def ended_fits(service: Service) -> list[str]:
    request = REQUEST | {"label": "Ada"}
    answers = [service.post({"number": number}, request=request) for number in range(KEPT)]
    paths = [answer.raise_for_status().headers["Location"] for answer in answers]
    assert {service.ended(path)["state"] for path in paths} == {"succeeded"}
    return paths


def contents(service: Service, paths: list[str]) -> Mapping[str, bytes]:
    """Everything that a caller can fetch of these fits."""
    found: dict[str, bytes] = {}
    for path in paths:
        links = [path, f"{path}/request", f"{path}/files/views/0/image", f"{path}/result"]
        result = service.client.get(f"{path}/result").raise_for_status().json()
        links += [f"{path}/files/{each['name']}" for each in result["files"]]
        for link in links:
            found[link] = service.client.get(link).raise_for_status().content
    return found


def test_a_dump_and_a_copied_bucket_bring_back_keys_fits_and_waiting_jobs(
    storage: ObjectStorage, databases: tuple[str, str], tmp_path: Path
):
    before, after = databases
    bucket = f"{storage.bucket}-restored"
    lost = Machine(tmp_path / "lost", before, KEYS | storage.settings)
    new = Machine(
        tmp_path / "new", after, KEYS | storage.settings | {"blob_url": f"s3://{bucket}/blobs"}
    )
    gate = tmp_path / "gate"
    key = {"Authorization": f"Bearer {new_key(lost)}"}
    with running_service(lost) as service:
        service.client.headers.update(key)
        paths = ended_fits(service)
        kept = contents(service, paths)
        waiting = [service.submit({"gate": str(gate), "number": 10 + at}) for at in range(2)]
        eventually(lambda: "running" in map(service.state, waiting), what="a fit is running")
        run_commands("backup-postgres", tmp_path, MAQUETTE_DATABASE_URL=before)
        copy_objects(storage, to=bucket)
    run_commands("restore-postgres", tmp_path, **new.environment())
    gate.touch()
    with running_service(new) as service:
        assert service.client.get("/v1/fits").status_code == httpx.codes.UNAUTHORIZED
        service.client.headers.update(key)
        assert contents(service, paths) == kept
        assert {service.ended(path)["state"] for path in waiting} == {"succeeded"}
        assert service.ended(service.submit())["state"] == "succeeded"


def test_a_copied_data_folder_brings_back_fits_though_the_service_runs_on(tmp_path: Path):
    data, restored = tmp_path / "maquette-data", tmp_path / "restored" / "maquette-data"
    with running_service(Machine(data)) as service:
        paths = ended_fits(service)
        kept = contents(service, paths)
        run_commands("backup-folder", tmp_path)
        service.ended(service.submit())
    restored.parent.mkdir()
    shutil.move(tmp_path / "backup", restored.parent)
    run_commands("restore-folder", restored.parent)
    with running_service(Machine(restored)) as service:
        assert contents(service, paths) == kept
        assert len(service.client.get("/v1/fits").json()["fits"]) == KEPT
        assert service.ended(service.submit())["state"] == "succeeded"
