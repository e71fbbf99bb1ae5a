"""What is kept: its owner alone may look at it, and nothing is left of it when it is erased."""

import contextlib
import hashlib
import os
import stat
import time
from collections.abc import Iterator
from datetime import datetime, timedelta
from pathlib import Path

import psycopg
import pytest
from psycopg import sql

from service.jobs.database import open_database, prepare_database
from service.process.data_folder import prepare_data_folder
from service.settings import Settings
from tests.integration.service.fake_pipeline import scripted_image
from tests.integration.service.harness import (
    FRONT_AND_SIDE,
    REQUEST,
    VIEW,
    Machine,
    Service,
    eventually,
    running_service,
)
from tests.integration.service.receiver import SECRET, Receiver
from tests.integration.service.test_images import blobs_below

PATH = "/hooks/one-time-token"
OTHERS = 0o077


def open_to_others(folder: Path) -> set[Path]:
    found = (folder, *folder.rglob("*"))
    return {path for path in found if stat.S_IMODE(path.lstat().st_mode) & OTHERS}


def test_what_was_open_to_others_is_closed(tmp_path: Path):
    settings = Settings(data_dir=tmp_path / "data")
    prepare_data_folder(settings)
    prepare_database(settings.system_database_url)
    reading = open_database(settings.system_database_url, connections=1)
    with reading.connect() as connection:
        connection.exec_driver_sql("SELECT count(*) FROM maquette_jobs")
        opened = (tmp_path / "data", *(tmp_path / "data").iterdir())
        assert len(opened) == 5
        for path in opened:
            path.chmod(0o777 if path.is_dir() else 0o666)
        prepare_data_folder(settings)
        open_database(settings.system_database_url).dispose()
        assert open_to_others(tmp_path / "data") == set()
    reading.dispose()


def test_a_folder_with_other_things_stays_open_and_what_is_ours_in_it_does_not(tmp_path: Path):
    tmp_path.chmod(0o755)
    (tmp_path / "somebody's").mkdir(mode=0o755)
    settings = Settings(data_dir=tmp_path)
    prepare_data_folder(settings)
    prepare_database(settings.system_database_url)
    assert open_to_others(tmp_path) == {tmp_path, tmp_path / "somebody's"}


def told(service: Service, receiver: Receiver) -> str:
    """Have a fit made and its end told; returns its path."""
    webhook = {"url": receiver.url(PATH), "secret": SECRET}
    path = service.post(request=REQUEST | {"webhook": webhook}).headers["Location"]
    service.ended(path)
    eventually(lambda: receiver.notices, what="it is told")
    return path


@pytest.mark.parametrize("machine", ["postgres"], indirect=True)
def test_whom_to_tell_and_the_secret_were_never_in_the_database(
    machine: Machine, receiver: Receiver
):
    told_machine = Machine(
        machine.data_dir, machine.database_url, settings={"webhook_hosts": "127.0.0.1"}
    )
    assert machine.database_url is not None
    with running_service(told_machine) as service:
        path = told(service, receiver)
        assert receiver.notices[0].path == PATH
        assert receiver.notices[0].is_signed_with(SECRET)
        job_id = path.rpartition("/")[2]
        before = written(machine.database_url)
        assert job_id.encode() in before
        assert service.client.delete(path).status_code == 204
        # Dead rows, as far as the server has not taken them away.
        files = before + written(machine.database_url)
    assert SECRET.encode() not in files
    assert PATH.encode() not in files
    assert not [each for each in machine.data_dir.rglob("*") if SECRET.encode() in content(each)]


def written(url: str) -> bytes:
    """All of the tables' files, with the rows that were deleted and not yet taken away."""
    with psycopg.connect(url, autocommit=True) as connection:
        connection.execute("CHECKPOINT")
        tables = connection.execute(
            "SELECT schemaname, tablename FROM pg_tables WHERE schemaname IN ('public', 'dbos')"
        ).fetchall()
        content = b""
        for schema, table in tables:
            name = sql.Identifier(schema, table).as_string(connection)
            row = connection.execute(
                "SELECT pg_read_binary_file(pg_relation_filepath(%s))", [name]
            ).fetchone()
            content += row[0] if row else b""
        return content


def content(path: Path) -> bytes:
    return path.read_bytes() if path.is_file() else b""


RETENTION_HOURS = 2.0
SCRIPT = {"n": "the-picture-itself"}
ERASED_SECRET = "whsec_" + "eraseThisSecretAtTheEndX" * 2
WEBHOOK = {"url": "http://127.0.0.1:9/erase-this-address", "secret": ERASED_SECRET}
PERSON = {"weight_kg": 83.7654321, "webhook": WEBHOOK}
POINTS = {**VIEW["points"], "nose": [321.1234567, 61.7654321]}
TRACES: dict[str, bytes] = {
    "picture": b"the-picture-itself",
    "picture's name": hashlib.sha256(scripted_image(SCRIPT)).hexdigest().encode(),
    "points": b"321.1234567",
    "weight": b"83.7654321",
    "result": b"The energy stopped decreasing.",
    "receiver": b"erase-this-address",
    "receiver's secret": ERASED_SECRET.encode(),
}


def traces(folder: Path) -> set[str]:
    """What is found in any file: blobs, the database, its write-ahead log."""
    found: set[str] = set()
    for path in folder.rglob("*"):
        try:
            content = path.read_bytes() if path.is_file() else b""
        except FileNotFoundError:  # erased while we look
            continue
        found |= {name for name, trace in TRACES.items() if trace in content}
    return found


def fitted(service: Service) -> str:
    """Have the remarkable picture fitted, seen twice, and return the fit's path."""
    views = [{"view": view, "points": POINTS} for view in ("front", "side")]
    answer = service.post_several(
        SCRIPT,
        SCRIPT,
        request=FRONT_AND_SIDE | PERSON | {"views": views},
        masks=[scripted_image(SCRIPT)] * 2,
    )
    assert answer.status_code == 202, answer.text
    return answer.headers["Location"]


SETTINGS = {
    "webhook_hosts": "127.0.0.1",
    "sweep_interval_s": 0.3,
    "retention_hours": RETENTION_HOURS,
}


@pytest.fixture(scope="module")
def erasing(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Service]:
    """A service that sweeps, started where files are open to all; leave no trace in it."""
    machine = Machine(tmp_path_factory.mktemp("above") / "data", settings=SETTINGS)
    before = os.umask(0)
    with contextlib.ExitStack() as stack:
        try:
            service = stack.enter_context(running_service(machine))
        finally:
            os.umask(before)
        yield service


def test_nobody_else_can_look_into_a_data_folder_of_a_running_service(erasing: Service):
    path, folder = erasing.fitted(), erasing.machine.data_dir
    there = {"blobs", "maquette.sqlite", "maquette.sqlite-wal", "maquette.sqlite-shm"}
    assert {each.name for each in folder.iterdir()} >= there
    assert open_to_others(folder) == set()
    assert erasing.client.delete(path).status_code == 204


def test_after_delete_no_byte_is_left(erasing: Service):
    service, folder = erasing, erasing.machine.data_dir
    path = fitted(service)
    assert service.ended(path)["state"] == "succeeded"
    picture = {"image": ("p.png", scripted_image(SCRIPT), "image/png")}
    uploaded = service.client.post("/v1/images", files=picture).headers["Location"]
    assert traces(folder) == set(TRACES)
    assert service.client.delete(path).status_code == 204
    assert service.client.delete(uploaded).status_code == 204
    for gone in (path, f"{path}/result", f"{path}/events", f"{path}/files/views/0/overlay.png"):
        assert service.client.get(gone).status_code == 404
    assert service.client.delete(path).status_code == 404
    eventually(lambda: not traces(folder), what=f"nothing is left of {set(TRACES)}")
    eventually(lambda: not blobs_below(folder), what="no file is left")


def test_after_its_time_no_byte_is_left(erasing: Service):
    service, folder = erasing, erasing.machine.data_dir
    path = fitted(service)
    job = service.ended(path)
    ended_at, expires_at = (
        datetime.fromisoformat(job[name]) for name in ("finished_at", "expires_at")
    )
    assert expires_at - ended_at == timedelta(hours=RETENTION_HOURS)
    eventually(lambda: traces(folder) == set(TRACES), what="the job was there")
    asked = service.client.post(f"{path}/products", json={"kind": "pose"})
    product = service.ended(asked.headers["Location"])["links"]["self"]
    service.machine.rewrite(path, expires_at=time.time())
    for gone in (path, product, f"{product}/files/pose.png"):
        eventually(lambda gone=gone: service.client.get(gone).status_code == 410, what=gone)
    eventually(lambda: not traces(folder), what=f"nothing is left of {set(TRACES)}")
    eventually(lambda: not blobs_below(folder), what="no file is left")
    assert service.client.get(path).status_code == 410
