"""Two hosts made of network namespaces, and the image run on them as an engine would."""

import contextlib
import ctypes
import os
import shutil
import signal
import subprocess
import time
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from tests.image.build import Image
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


PREPARED: Final = """
mount --bind "$ROOT" "$ROOT"
mount -o remount,bind,ro "$ROOT"
mount -t proc proc "$ROOT/proc"
mount -t tmpfs -o mode=1777 tmpfs "$ROOT/tmp"
mount --rbind /dev "$ROOT/dev"
hostname "$NAME"
exec chroot "$ROOT" /usr/bin/env -i "$@"
"""
UNSHARED: Final = ("unshare", "--mount", "--uts", "--ipc", "--pid", "--fork")


@dataclass
class Container:
    """A process that is the first of its namespaces."""

    image: Image
    host: str
    environment: Mapping[str, str]
    process: subprocess.Popen[bytes]

    @property
    def pid(self) -> int:
        """The first process, as the machine counts."""
        pid = self.process.pid
        while not (children := Path(f"/proc/{pid}/task/{pid}/children").read_text().split()):
            assert self.process.poll() is None, "the container has ended"
            time.sleep(0.01)
        return int(children[0])

    def kill(self) -> None:
        """End everything in it at once: with the first process of their namespace all others go."""
        os.kill(self.pid, signal.SIGKILL)
        self.process.wait()

    def execute(self, *command: str) -> subprocess.CompletedProcess[str]:
        """Run another command inside."""
        user, group = self.image.user
        inside = ("--mount", "--uts", "--ipc", "--pid", "--net", "--root", "--wd")
        return subprocess.run(
            ["nsenter", f"--target={self.pid}", *inside, f"--setuid={user}", f"--setgid={group}"]
            + ["/usr/bin/env", "-i", *_pairs(self.environment), *command],
            check=False,
            capture_output=True,
            text=True,
        )

    def kernels(self) -> int:
        """How many compiled kernels its processes have, from the image or of their own."""
        return len(list((Path(f"/proc/{self.pid}/root") / "tmp").rglob("*.nbc")))


@contextlib.contextmanager
def running(
    image: Image, *command: str, host: str, name: str, settings: Mapping[str, str]
) -> Iterator[Container]:
    """Run a command in a container on a host (a network namespace) until the end of the block."""
    environment = {**image.environment, **settings}
    user, group = image.user
    confined = ("setpriv", f"--reuid={user}", f"--regid={group}", "--clear-groups")
    confined += ("--no-new-privs", "--bounding-set=-all", "--inh-caps=-all")
    process = subprocess.Popen(
        ["ip", "netns", "exec", host, *UNSHARED, "sh", "-ec", PREPARED, "prepared"]
        + [*_pairs(environment), *confined, *image.entrypoint, *command],
        env={"PATH": "/usr/sbin:/usr/bin:/sbin:/bin", "ROOT": str(image.root), "NAME": name},
        stdin=subprocess.DEVNULL,
    )
    container = Container(image, host, environment, process)
    try:
        yield container
    finally:
        if process.poll() is None:
            container.kill()


def _pairs(environment: Mapping[str, str]) -> list[str]:
    return [f"{name}={value}" for name, value in environment.items()]
