"""Who may look at what is kept: its owner alone; and nobody finds secrets in a database."""

import os
import stat
from pathlib import Path

import psycopg
import pytest
from psycopg import sql

from service.jobs.database import open_database, prepare_database
from service.process.data_folder import prepare_data_folder
from service.settings import Settings
from tests.integration.service.harness import (
    REQUEST,
    Machine,
    Service,
    eventually,
    running_service,
)
from tests.integration.service.receiver import SECRET, Receiver

PATH = "/hooks/one-time-token"
OTHERS = 0o077


def open_to_others(folder: Path) -> set[Path]:
    found = (folder, *folder.rglob("*"))
    return {path for path in found if stat.S_IMODE(path.lstat().st_mode) & OTHERS}


def test_nobody_else_can_look_into_a_data_folder_of_a_running_service(tmp_path: Path):
    machine = Machine(tmp_path / "above" / "data")
    before = os.umask(0)
    try:
        with running_service(machine) as service:
            service.ended(service.submit())
            assert {path.name for path in machine.data_dir.iterdir()} >= {
                "blobs",
                "maquette.sqlite",
                "maquette.sqlite-wal",
                "maquette.sqlite-shm",
            }
            assert open_to_others(machine.data_dir) == set()
    finally:
        os.umask(before)


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
        assert job_id.encode() in written(machine.database_url)
        assert service.client.delete(path).status_code == 204
        files = written(machine.database_url)
    # Dead rows still hold the job's id, and nothing that was secret.
    assert job_id.encode() in files
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
