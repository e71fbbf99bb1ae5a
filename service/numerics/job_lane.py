"""The lane of jobs: a child for each, kept a moment for the next job of the same owner.

A forked process makes its pages its own while it runs its first job, and does for the first time
what it does in every one: 0.07 s of processor, a third of a small fit. The next job is spared that.
"""

import threading
from collections.abc import Hashable
from dataclasses import dataclass
from typing import Final

from service.numerics.fork_server import Child, CrashesInARow, ForkServer
from service.numerics.tasks import ChildSetup

KEPT_S: Final = 1.0
"""How long a process waits: a worker that idles holds no memory for it."""


@dataclass(frozen=True, slots=True, eq=False)
class _Kept:
    child: Child
    owner: Hashable
    timer: threading.Timer


class JobLane:
    """Starts children, and keeps each for a second, no more than there are slots without a job."""

    def __init__(
        self, server: ForkServer, setup: ChildSetup, *, jobs: int, kept_s: float = KEPT_S
    ) -> None:
        self._server = server
        self._setup = setup
        self._jobs = jobs
        self._kept_s = kept_s
        self._lock = threading.Lock()
        self._kept: list[_Kept] = []
        self._crashes = CrashesInARow(server)

    def start(self) -> Child:
        """Start a child.

        Raises
        ------
        NoProcessError
            If the fork server dies, however often it is started.
        """
        return self._server.start_child(self._setup)

    def keep(self, child: Child, owner: Hashable) -> None:
        """Keep a child that has done its job, unless that was its last one."""
        if child.tasks >= self._jobs:
            child.end()
            return
        timer = threading.Timer(self._kept_s, self._end, (child,))
        timer.daemon = True
        with self._lock:
            self._kept.append(_Kept(child, owner, timer))
        timer.start()

    def take(self, owner: Hashable) -> Child | None:
        """Return a child of this owner, or end one of another in favour of a new one."""
        with self._lock:
            if not self._kept:
                return None
            found = next((each for each in self._kept if each.owner == owner), self._kept[0])
            self._kept.remove(found)
        found.timer.cancel()
        if found.owner == owner and found.child.is_waiting():
            return found.child
        found.child.end()
        return None

    def note_end(self, *, crashed: bool) -> None:
        """Note whether a job crashed, so that a damaged fork server is replaced."""
        self._crashes.note(crashed=crashed)

    def _end(self, child: Child) -> None:
        with self._lock:
            found = next((each for each in self._kept if each.child is child), None)
            if found is None:
                return
            self._kept.remove(found)
        child.end()
