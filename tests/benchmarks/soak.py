"""Memory of API and worker while jobs come, are followed, fetched and erased for minutes."""

import tempfile
import time
from collections.abc import Iterator
from pathlib import Path

import httpx

from fitter.training.text_tables import note_lines, table_lines
from tests.benchmarks.crowd import crowd
from tests.benchmarks.served import NO_WORKER, ready, running
from tests.deployment import Deployment, Kind
from tests.process_table import own_memory_mib
from tests.submissions import small_submissions

PICTURES = 4
KEPT = 20
LISTENERS = 20
POLLERS = 10
MINUTE_S = 60.0
WATCHED = (Kind.API, Kind.WORKER, Kind.FORK_SERVER, Kind.ESTIMATOR)


def lines(count: int) -> Iterator[str]:
    """``count`` minutes; all but the last jobs are erased."""
    submissions = small_submissions(PICTURES)
    rows: list[tuple[str, ...]] = []
    with tempfile.TemporaryDirectory(prefix="maquette-benchmark-") as folder:
        deployment = Deployment(folder=Path(folder), commands=NO_WORKER, workers=1)
        with running(deployment), httpx.Client(base_url=deployment.address, timeout=120) as client:
            ready(client)
            kept: list[str] = []
            ended = 0
            for minute in range(count + 1):
                rows.append(_row(minute, ended, deployment))
                until = time.monotonic() + MINUTE_S
                while minute < count and time.monotonic() < until:
                    while len(kept) < KEPT:
                        files = submissions[len(kept) % PICTURES].files
                        answer = client.post("/v1/fits", files=files).raise_for_status()
                        kept.append(answer.headers["Location"])
                    with crowd(
                        deployment.port, listening_to=kept[:LISTENERS], polling=kept[-POLLERS:]
                    ):
                        ended += _fetched_and_erased(client, kept)
    yield from table_lines(
        f"Soak of {count} minutes: {LISTENERS} listeners, {POLLERS} pollers, MiB of each alone",
        ("minute", "jobs ended", *(kind.value for kind in WATCHED)),
        rows,
    )
    yield from note_lines(
        "Each job is followed to its end, all its files are fetched, it is erased."
    )


def _fetched_and_erased(client: httpx.Client, kept: list[str]) -> int:
    """Take the oldest half of the jobs to their end; how many that were."""
    oldest = kept[: KEPT // 2]
    for path in oldest:
        with client.stream("GET", f"{path}/events", timeout=None) as events:
            for _ in events.iter_lines():
                pass
        job = client.get(path).raise_for_status().json()
        for file in job["links"]["artifacts"].values():
            client.get(file).raise_for_status()
        client.delete(path).raise_for_status()
    del kept[: len(oldest)]
    return len(oldest)


def _row(minute: int, ended: int, deployment: Deployment) -> tuple[str, ...]:
    memory = (
        sum(own_memory_mib(process.pid) for process in deployment.of_kind(kind)) for kind in WATCHED
    )
    return (str(minute), str(ended), *(f"{each:.1f}" for each in memory))
