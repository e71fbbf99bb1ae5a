"""Child processes that have done a job well and wait for the next one of the same owner.

A forked process makes its pages its own while it runs its first job, and does for the first time
what it does in every one: 0.07 s of processor, a third of a small fit. The next job is spared that.
"""

import threading
from collections.abc import Iterable
from dataclasses import dataclass
from multiprocessing.connection import Connection
from multiprocessing.context import ForkServerProcess
from typing import Final, NamedTuple

from service.engine.port import JobRecord
from service.worker.child_tasks import ChildTask, give
from service.worker.fork_server import end

KEPT_S: Final = 1.0
"""How long a process waits: a worker that idles holds no memory for it."""


class Owner(NamedTuple):
    """Who may see a job. A process that a picture took over would see no more than that."""

    tenant: str
    token: str | None


def owner_of(job: JobRecord) -> Owner:
    """Who may see the job: who has its tenant's keys, or the token it was made with."""
    return Owner(job.tenant, job.token)


@dataclass(slots=True, eq=False)
class Child:
    """A process for jobs, and how many it was given."""

    connection: Connection
    process: ForkServerProcess
    jobs: int = 0

    def give(self, task: ChildTask, parts: Iterable[bytes]) -> None:
        """Send it a job."""
        self.jobs += 1
        give(self.connection, task, parts)

    def is_waiting(self) -> bool:
        """Whether it is alive and says nothing that nobody asked for."""
        return self.process.is_alive() and not self.connection.poll()

    def end(self) -> None:
        """Kill it."""
        end(self.connection, self.process)


@dataclass(frozen=True, slots=True, eq=False)
class _Kept:
    child: Child
    owner: Owner
    timer: threading.Timer


class KeptChildren:
    """Keeps each for a second, and no more than there are slots without a job."""

    def __init__(self, *, jobs: int, kept_s: float = KEPT_S) -> None:
        self._jobs = jobs
        self._kept_s = kept_s
        self._lock = threading.Lock()
        self._kept: list[_Kept] = []

    def keep(self, child: Child, owner: Owner) -> None:
        """Keep a process that has done its job, unless that was its last one."""
        if child.jobs >= self._jobs:
            child.end()
            return
        timer = threading.Timer(self._kept_s, self._end, (child,))
        timer.daemon = True
        with self._lock:
            self._kept.append(_Kept(child, owner, timer))
        timer.start()

    def take(self, owner: Owner) -> Child | None:
        """Return a process of this owner, or end one of another in favour of a new one."""
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

    def _end(self, child: Child) -> None:
        with self._lock:
            found = next((each for each in self._kept if each.child is child), None)
            if found is None:
                return
            self._kept.remove(found)
        child.end()
