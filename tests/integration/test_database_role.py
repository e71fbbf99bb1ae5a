"""The role that compose's database gets: it can run the service, and has no other rights."""

import os
import shutil
import subprocess
from collections.abc import Iterator
from pathlib import Path

import psycopg
import pytest

from service.jobs.database import open_database, prepare_database
from service.jobs.keys import KeyRing
from tests.postgres import server_folder

SCRIPT = Path(__file__).parents[2] / "docker" / "database_role.sh"
PASSWORD = "it's a 'password' with $signs and \\ strokes"


def programs() -> Path:
    """Where a Postgres server's programs are; skips where there are none."""
    found = sorted(Path("/usr/lib/postgresql").glob("*/bin/pg_ctl"))
    if not found:
        pytest.skip("no Postgres server is installed; Debian's package postgresql has it")
    return found[-1].parent


def as_server() -> tuple[str, ...]:
    """How a command is begun that root may not run."""
    if os.getuid() != 0:
        return ()
    return ("setpriv", "--reuid=postgres", "--regid=postgres", "--clear-groups")


@pytest.fixture(scope="module")
def server() -> Iterator[Path]:
    """The socket's folder of a server of its own, on which the script has run."""
    bin_folder = programs()
    folder = server_folder()
    if as_server():
        shutil.chown(folder, "postgres", "postgres")
    data = folder / "data"
    quiet = {"check": True, "stdout": subprocess.DEVNULL, "cwd": folder}
    access = ("--auth-local=scram-sha-256", f"--pwfile={folder / 'password'}")
    (folder / "password").write_text("of the superuser")
    subprocess.run(
        [*as_server(), bin_folder / "initdb", "-U", "postgres", *access, "-D", data], **quiet
    )
    control = (*as_server(), bin_folder / "pg_ctl", "-D", data, "-w")
    options = f"-c listen_addresses='' -c unix_socket_directories={folder}"
    subprocess.run([*control, "-l", folder / "log", "-o", options, "start"], **quiet)
    try:
        told = {
            "PATH": f"{bin_folder}:{os.environ['PATH']}",
            "PGHOST": str(folder),
            "PGPASSWORD": "of the superuser",
            "POSTGRES_USER": "postgres",
            "ROLE_PASSWORD": PASSWORD,
        }
        subprocess.run(["sh", "-e", str(SCRIPT)], check=True, env=told)
        yield folder
    finally:
        subprocess.run([*control, "-m", "immediate", "stop"], **quiet)
        shutil.rmtree(folder)


@pytest.fixture
def url(server: Path, monkeypatch: pytest.MonkeyPatch) -> str:
    monkeypatch.setenv("PGPASSWORD", PASSWORD)
    return f"postgresql://maquette@/maquette?host={server}"


def test_the_role_makes_the_tables_of_the_service_and_uses_them(url: str):
    for _ in range(2):
        prepare_database(url)
    database = open_database(url, connections=1)
    try:
        ring = KeyRing(database)
        ring.create("somebody")
        assert [key.tenant for key in ring.all_keys()] == ["somebody"]
    finally:
        database.dispose()


def test_the_role_has_no_rights_but_over_its_own_database(url: str):
    with psycopg.connect(url, autocommit=True) as connection:
        rights = connection.execute(
            "SELECT rolsuper, rolcreatedb, rolcreaterole, rolreplication, rolbypassrls"
            " FROM pg_roles WHERE rolname = current_user"
        ).fetchone()
        assert rights == (False,) * 5
        for forbidden in (
            "CREATE DATABASE other",
            "CREATE ROLE other",
            "COPY (SELECT 1) TO PROGRAM 'true'",
            "SELECT pg_read_file('/etc/hostname')",
        ):
            with pytest.raises(psycopg.errors.InsufficientPrivilege):
                connection.execute(forbidden)
