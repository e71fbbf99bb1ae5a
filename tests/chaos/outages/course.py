"""Fifty jobs come in, a fault begins and ends meanwhile, and all jobs come out."""

import contextlib
import threading
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field

from tests.chaos.outages.client import Followed, GoodClient
from tests.chaos.outages.exchanges import Exchange, Ledger
from tests.chaos.outages.probes import Probes, probing
from tests.deployment import Deployment, wait_for
from tests.submissions import Submission

AT_ONCE = 10
"""Jobs posted without a pause, so that workers are busy when the fault begins."""

SENDERS = 4
TAIL_S = 20.0
"""The rest is posted evenly until so long after the fault."""

BUSY_WITHIN_S = 60.0
SETTLED_S = 10.0
RUNNING = "maquette_running_jobs"
LOOK_S = 0.05


@dataclass(frozen=True, slots=True, kw_only=True)
class Scene:
    """A service, and how what it stands on breaks and is mended."""

    deployment: Deployment
    begin: Callable[[], None]
    end: Callable[[], None]
    running: int = 2
    """Jobs that must be running when it begins."""


@dataclass(slots=True, kw_only=True)
class Course:
    """What the clients saw; moments are of the monotonic clock."""

    fault_s: float
    began_at: float = 0.0
    ended_at: float = 0.0
    jobs: list[Followed] = field(default_factory=list[Followed])
    gave_up: list[str] = field(default_factory=list[str])
    second_answers: int = 0
    exchanges: list[Exchange] = field(default_factory=list[Exchange])
    busy_at: float = 0.0
    """When all workers were first seen at work after the fault."""
    log: str = ""


def undergo(scene: Scene, tasks: Sequence[Submission], *, jobs: int, fault_s: float) -> Course:
    """Submit the jobs, let the fault last ``fault_s`` seconds, and wait for all ends."""
    course, ledger = Course(fault_s=fault_s), Ledger()
    deployment = scene.deployment
    logged_before = deployment.log.stat().st_size
    with (
        probing(deployment.address, ledger) as probes,
        contextlib.closing(GoodClient(deployment.address, ledger)) as again,
    ):
        posting = _Posting(deployment.address, ledger, tasks, course)
        threads = posting.start(jobs, pace_s=(fault_s + TAIL_S) / (jobs - AT_ONCE))
        _await_work(scene, course, probes)
        course.began_at = time.monotonic()
        scene.begin()
        _keep_running(deployment, until=course.began_at + fault_s)
        scene.end()
        course.ended_at = time.monotonic()
        while any(thread.is_alive() for thread in (*threads, *posting.followers)):
            deployment.keep_running()
            time.sleep(LOOK_S)
        _keep_running(deployment, until=time.monotonic() + SETTLED_S)
        course.second_answers = sum(
            again.post(tasks[job.which], key=job.key) != job.path for job in course.jobs if job.path
        )
    course.busy_at = min(
        (
            moment
            for moment, figures in probes.figures
            if moment > course.ended_at and figures.get(RUNNING, 0.0) >= scene.running
        ),
        default=course.ended_at,
    )
    course.exchanges = ledger.all()
    with deployment.log.open(errors="replace") as stream:
        stream.seek(logged_before)
        course.log = stream.read()
    return course


class _Posting:
    def __init__(
        self,
        address: str,
        ledger: Ledger,
        tasks: Sequence[Submission],
        course: Course,
    ) -> None:
        self._address = address
        self._ledger = ledger
        self._tasks = tasks
        self._course = course
        self.followers: list[threading.Thread] = []

    def start(self, jobs: int, *, pace_s: float) -> list[threading.Thread]:
        began = time.monotonic()
        due = [began + max(0, number - AT_ONCE) * pace_s for number in range(jobs)]
        threads = [
            threading.Thread(target=self._send, args=(range(first, jobs, SENDERS), due))
            for first in range(SENDERS)
        ]
        for thread in threads:
            thread.start()
        return threads

    def _send(self, numbers: Sequence[int], due: Sequence[float]) -> None:
        with contextlib.closing(self._client()) as client:
            for number in numbers:
                time.sleep(max(0.0, due[number] - time.monotonic()))
                job = Followed(
                    key=f"fault-{number}",
                    which=number % len(self._tasks),
                    posted_at=time.monotonic(),
                )
                self._course.jobs.append(job)
                with self._giving_up(job):
                    job.path = client.post(self._tasks[job.which], key=job.key)
                    job.accepted_at = time.monotonic()
                    follower = threading.Thread(target=self._follow, args=(number, job))
                    follower.start()
                    self.followers.append(follower)

    def _follow(self, number: int, job: Followed) -> None:
        with contextlib.closing(self._client()) as client, self._giving_up(job):
            (client.follow if number % 2 else client.poll)(job)

    def _client(self) -> GoodClient:
        return GoodClient(self._address, self._ledger)

    @contextlib.contextmanager
    def _giving_up(self, job: Followed) -> Iterator[None]:
        try:
            yield
        except Exception as error:
            self._course.gave_up.append(f"{job.key}: {error!r}")


def _await_work(scene: Scene, course: Course, probes: Probes) -> None:
    def is_busy() -> bool:
        running = probes.latest(RUNNING) or 0.0
        return running >= scene.running and sum(job.ends for job in list(course.jobs)) >= 2

    wait_for(is_busy, within_s=BUSY_WITHIN_S)


def _keep_running(deployment: Deployment, *, until: float) -> None:
    while time.monotonic() < until:
        deployment.keep_running()
        time.sleep(LOOK_S)
