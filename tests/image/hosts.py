"""Two hosts that reach each other by a cable, made of network namespaces."""

import contextlib
import ctypes
import os
import shutil
import subprocess
from collections.abc import Iterator
from pathlib import Path
from typing import Final

from tests.postgres import server_folder

FRONT: Final = "maquette-front"
BACK: Final = "maquette-back"
ADDRESSES: Final = {FRONT: "10.213.7.1", BACK: "10.213.7.2"}
POSTGRES_PORT: Final = 5432
POSTGRES_PASSWORD: Final = "a password with / and @"
CLONE_NEWNET: Final = 0x40000000


@contextlib.contextmanager
def two_hosts() -> Iterator[None]:
    """Make both hosts and the cable; they go at the end."""
    try:
        for name in ADDRESSES:
            _ip("netns", "add", name)
            _ip("-n", name, "link", "set", "lo", "up")
        _ip("-n", FRONT, "link", "add", "cable", "type", "veth", "peer", "cable", "netns", BACK)
        for name, address in ADDRESSES.items():
            _ip("-n", name, "address", "add", f"{address}/24", "dev", "cable")
            _ip("-n", name, "link", "set", "cable", "up")
        yield
    finally:
        for name in ADDRESSES:
            subprocess.run(["ip", "netns", "delete", name], check=False)


@contextlib.contextmanager
def entered(host: str) -> Iterator[None]:
    """Let this thread, and the threads it starts meanwhile, be on a host."""
    here = os.open("/proc/thread-self/ns/net", os.O_RDONLY)
    there = os.open(f"/run/netns/{host}", os.O_RDONLY)
    try:
        _set_network(there)
        yield
    finally:
        _set_network(here)
        os.close(here)
        os.close(there)


@contextlib.contextmanager
def running_postgres(host: str) -> Iterator[str]:
    """Run an empty Postgres that both hosts reach with a password, and give its address."""
    programs = max(Path("/usr/lib/postgresql").iterdir()) / "bin"
    folder = server_folder()
    shutil.chown(folder, "postgres", "postgres")
    data = folder / "data"
    as_postgres = ("setpriv", "--reuid=postgres", "--regid=postgres", "--clear-groups")
    quiet = {"check": True, "stdout": subprocess.DEVNULL, "cwd": folder}
    (folder / "password").write_text(POSTGRES_PASSWORD)
    make = (programs / "initdb", f"--pwfile={folder / 'password'}", "-A", "scram-sha-256")
    subprocess.run([*as_postgres, *make, "-D", data], **quiet)
    with (data / "pg_hba.conf").open("a") as stream:
        stream.write("host all all 10.213.7.0/24 scram-sha-256\n")
    options = f"-c listen_addresses={ADDRESSES[host]} -c unix_socket_directories={folder}"
    inside = ("ip", "netns", "exec", host, *as_postgres)
    control = (programs / "pg_ctl", "-D", data, "-w")
    log = folder / "log"
    subprocess.run([*inside, *control, "-l", log, "-o", options, "start"], **quiet)
    try:
        yield f"postgresql://postgres@{ADDRESSES[host]}:{POSTGRES_PORT}/postgres"
    finally:
        subprocess.run([*as_postgres, *control, "-m", "immediate", "stop"], **quiet)
        shutil.rmtree(folder)


def _set_network(descriptor: int) -> None:
    library = ctypes.CDLL(None, use_errno=True)
    if library.setns(descriptor, CLONE_NEWNET) != 0:
        number = ctypes.get_errno()
        raise OSError(number, os.strerror(number))


def _ip(*arguments: str) -> None:
    subprocess.run(["ip", *arguments], check=True)
