"""Memory of API and worker, each alone, while jobs come, are followed, fetched and erased."""

import tempfile
import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import httpx

from fitter.training.report.text_tables import note_lines, table_lines
from tests.benchmarks.crowd import crowd
from tests.benchmarks.served import NO_WORKER, all_ended, ready, running
from tests.deployment import Deployment, Kind, wait_for
from tests.process_table import KIB_PER_MIB, own_memory_mib
from tests.submissions import Submission, small_submissions

PICTURES = 4
KEPT = 20
LISTENERS = 20
POLLERS = 10
MINUTE_S = 60.0
WATCHED = (Kind.API, Kind.WORKER, Kind.FORK_SERVER, Kind.ESTIMATOR)


def lines(count: int) -> Iterator[str]:
    """``count`` minutes; all but the last jobs are erased."""
    submissions = small_submissions(PICTURES)
    looks: list[_Look] = []
    with tempfile.TemporaryDirectory(prefix="maquette-benchmark-") as folder:
        deployment = Deployment(folder=Path(folder), commands=NO_WORKER, workers=1)
        with running(deployment), httpx.Client(base_url=deployment.address, timeout=120) as client:
            ready(client)
            kept: list[str] = []
            ended = 0
            for minute in range(count + 1):
                _submit(client, kept, submissions)
                _settle(client, kept, deployment)
                looks.append(_look(ended, deployment))
                until = time.monotonic() + MINUTE_S
                while minute < count and time.monotonic() < until:
                    _submit(client, kept, submissions)
                    with crowd(
                        deployment.port, listening_to=kept[:LISTENERS], polling=kept[-POLLERS:]
                    ):
                        ended += _fetched_and_erased(client, kept)
    yield from table_lines(
        f"Soak of {count} minutes: {LISTENERS} listeners, {POLLERS} pollers, MiB of each alone",
        ("minute", "jobs ended", *(kind.value for kind in WATCHED)),
        [
            *((str(minute), *each.cells()) for minute, each in enumerate(looks)),
            _growth(looks),
        ],
    )
    yield from note_lines(
        "Each job is followed to its end, all its files are fetched, it is erased. The first "
        "minutes fill what a process keeps: threads and their heaps, connections and their caches. "
        "What it loses shows in the second half. It is looked at while no fit runs."
    )


def _submit(client: httpx.Client, kept: list[str], submissions: Sequence[Submission]) -> None:
    """As many jobs as are to be there."""
    while len(kept) < KEPT:
        files = submissions[len(kept) % PICTURES].files
        kept.append(client.post("/v1/fits", files=files).raise_for_status().headers["Location"])


def _settle(client: httpx.Client, kept: Sequence[str], deployment: Deployment) -> None:
    """Wait until no fit runs.

    A forked fit shares the fork server's memory, of which then next to nothing is the server's own.
    """
    all_ended(client, kept)
    wait_for(lambda: not deployment.of_kind(Kind.FIT), within_s=MINUTE_S)


def _fetched_and_erased(client: httpx.Client, kept: list[str]) -> int:
    """Take the oldest half of the jobs to their end; how many that were."""
    oldest = kept[: KEPT // 2]
    for path in oldest:
        with client.stream("GET", f"{path}/events", timeout=None) as events:
            for _ in events.iter_lines():
                pass
        job = client.get(path).raise_for_status().json()
        for file in job["links"]["files"].values():
            client.get(file).raise_for_status()
        client.delete(path).raise_for_status()
    del kept[: len(oldest)]
    return len(oldest)


@dataclass(frozen=True, slots=True, kw_only=True)
class _Look:
    """Jobs that have ended so far, and the memory of each kind of process, MiB."""

    ended: int
    memory_mib: tuple[float, ...]

    def cells(self) -> tuple[str, ...]:
        return (str(self.ended), *(f"{each:.1f}" for each in self.memory_mib))


def _look(ended: int, deployment: Deployment) -> _Look:
    return _Look(
        ended=ended,
        memory_mib=tuple(
            sum(own_memory_mib(process.pid) for process in deployment.of_kind(kind))
            for kind in WATCHED
        ),
    )


def _growth(looks: Sequence[_Look]) -> tuple[str, ...]:
    middle, last = looks[len(looks) // 2], looks[-1]
    jobs = max(last.ended - middle.ended, 1)
    return (
        "KiB a job, second half",
        str(jobs),
        *(
            f"{KIB_PER_MIB * (after - before) / jobs:+.1f}"
            for before, after in zip(middle.memory_mib, last.memory_mib, strict=True)
        ),
    )
