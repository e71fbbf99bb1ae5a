"""Two hosts of a run's own, made of network namespaces, and the cable between them."""

import contextlib
import os
import subprocess
from collections.abc import Iterator

from tests.image.hosts import entered

HERE_ADDRESS = "10.213.9.1"
THERE_ADDRESS = "10.213.9.2"
NETWORK = "10.213.9.0/24"


class Cable:
    """Between ``here``, where this thread and what it starts is, and ``there``."""

    def __init__(self, here: str, there: str) -> None:
        self.here = here
        self.there = there

    def cut(self) -> None:
        """Let nothing pass."""
        _ip("-n", self.here, "link", "set", "cable", "down")

    def mend(self) -> None:
        """Let everything pass again."""
        _ip("-n", self.here, "link", "set", "cable", "up")

    def command(self, *command: str) -> tuple[str, ...]:
        """A command that runs there, under a host name of its own."""
        renamed = ("unshare", "--uts", "sh", "-c", 'hostname "$0" && exec "$@"', "cut-off")
        return ("ip", "netns", "exec", self.there, *renamed, *command)


@contextlib.contextmanager
def two_hosts() -> Iterator[Cable]:
    """Make both hosts and be on the first; they go at the end, with whatever is between them."""
    cable = Cable(f"maquette-here-{os.getpid()}", f"maquette-there-{os.getpid()}")
    with contextlib.ExitStack() as stack:
        for name in (cable.here, cable.there):
            _ip("netns", "add", name)
            stack.callback(_ip, "netns", "delete", name)
            _ip("-n", name, "link", "set", "lo", "up")
        peer = ("type", "veth", "peer", "cable", "netns", cable.there)
        _ip("-n", cable.here, "link", "add", "cable", *peer)
        for name, address in ((cable.here, HERE_ADDRESS), (cable.there, THERE_ADDRESS)):
            _ip("-n", name, "address", "add", f"{address}/24", "dev", "cable")
            _ip("-n", name, "link", "set", "cable", "up")
        stack.enter_context(entered(cable.here))
        yield cable


def _ip(*arguments: str) -> None:
    subprocess.run(["ip", *arguments], check=True)
