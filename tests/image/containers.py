"""Run the image as a container engine would: confined by namespaces, read-only, without rights."""

import contextlib
import os
import signal
import subprocess
import time
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from tests.image.build import Image

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
