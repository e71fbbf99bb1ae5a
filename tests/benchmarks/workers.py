"""Jobs a second with 1, 2 and 4 workers on Postgres."""

import contextlib
import json
import sys
import tempfile
import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import httpx

from fitter.training.report.text_tables import note_lines, table_lines
from tests.benchmarks.served import NO_WORKER, all_ended, ready, running, used_s
from tests.deployment import Commands, Deployment, Kind
from tests.integration.service.fake_pipeline import scripted_image
from tests.integration.service.harness import REQUEST
from tests.postgres import fresh_database
from tests.submissions import Submission, small_submissions

WORKERS = (1, 2, 4)
FITS_A_WORKER = 2
WAIT_S = 1.0

FAKED = Commands(
    serve=(sys.executable, "-m", "tests.integration.service.fake_serve", "--no-worker"),
    worker=(sys.executable, "-m", "tests.integration.service.fake_worker"),
)


def lines(count: int) -> Iterator[str]:
    """``count`` jobs a worker: real small fits, then ones that only wait for a second."""
    real = small_submissions(4)
    waiting = [Submission(image=scripted_image({"seconds": WAIT_S}), request=json.dumps(REQUEST))]
    for title, commands, submissions, places in (
        ("Small fits, one at a time a worker", NO_WORKER, real, 1),
        (
            f"Faked fits that wait for {WAIT_S:g} s, {FITS_A_WORKER} at a time a worker",
            FAKED,
            waiting,
            FITS_A_WORKER,
        ),
    ):
        rows: list[tuple[str, ...]] = []
        first = 0.0
        for workers in WORKERS:
            taken = _taken(
                commands, submissions, workers=workers, places=places, jobs=count * workers
            )
            first = first or taken.rate
            share = f"{taken.rate / (workers * places / WAIT_S):.2f}" if commands is FAKED else ""
            rows.append(
                (
                    str(workers),
                    f"{taken.rate:.2f}",
                    f"{taken.rate / first:.2f}",
                    share,
                    f"{taken.processors:.2f}",
                )
            )
        yield from table_lines(
            f"{title}, Postgres",
            ("workers", "jobs a second", "times one", "of what waiting allows", "processors"),
            rows,
        )
    yield from note_lines(
        "From the start of the first job to the end of the last. Real fits stop gaining at the "
        "number of processors; the faked ones, which use none, show what the queue allows. "
        "Processors: how many of them API, workers and fits used; Postgres comes on top."
    )


@dataclass(frozen=True, slots=True, kw_only=True)
class _Taken:
    """Jobs a second, and the processors that API, workers and fits used for them."""

    rate: float
    processors: float


def _taken(
    commands: Commands, submissions: list[Submission], *, workers: int, places: int, jobs: int
) -> _Taken:
    with contextlib.ExitStack() as stack:
        folder = stack.enter_context(tempfile.TemporaryDirectory(prefix="maquette-benchmark-"))
        deployment = Deployment(
            folder=Path(folder),
            commands=commands,
            database_url=stack.enter_context(fresh_database()),
            settings={"worker_processes": places},
            workers=workers,
        )
        stack.enter_context(running(deployment))
        client = stack.enter_context(httpx.Client(base_url=deployment.address, timeout=120))
        ready(client)
        _await_workers(client, workers)
        paths = [
            client.post("/v1/fits", files=submissions[number % len(submissions)].files)
            .raise_for_status()
            .headers["Location"]
            for number in range(jobs)
        ]
        began, used = time.monotonic(), _used_s(deployment)
        done_before = sum(_is_done(client, path) for path in paths)
        all_ended(client, paths)
        seconds = time.monotonic() - began
        return _Taken(
            rate=(jobs - done_before) / seconds,
            processors=(_used_s(deployment) - used) / seconds,
        )


def _used_s(deployment: Deployment) -> float:
    kinds = (Kind.API, Kind.WORKER, Kind.FORK_SERVER, Kind.FIT)
    return sum(used_s(deployment, kind) for kind in kinds)


def _await_workers(client: httpx.Client, workers: int) -> None:
    while client.get("/healthz/ready").raise_for_status().json()["workers"] < workers:
        time.sleep(0.2)


def _is_done(client: httpx.Client, path: str) -> bool:
    return client.get(path).raise_for_status().json()["state"] == "succeeded"
