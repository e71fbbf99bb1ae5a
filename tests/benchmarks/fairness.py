"""How long a tenant's single job waits behind all that another tenant has sent."""

import contextlib
import json
import sys
import tempfile
import time
from collections.abc import Iterator
from datetime import datetime
from pathlib import Path
from typing import Any

import httpx

from fitter.training.report.text_tables import note_lines, table_lines
from service.engine.database import open_database
from service.engine.keys import KeyRing
from tests.benchmarks.served import all_ended, ready, running
from tests.deployment import Commands, Deployment
from tests.integration.service.fake_pipeline import scripted_image
from tests.integration.service.harness import REQUEST
from tests.postgres import fresh_database
from tests.submissions import Submission

SLOTS = 2
JOB_S = 1.0
FIRST_OF_THE_OTHERS = 4
"""So many of the others' jobs are done or begun when the single one is sent."""

FAKED = Commands(
    serve=(sys.executable, "-m", "tests.integration.service.fake_serve"),
    worker=(sys.executable, "-m", "tests.integration.service.fake_worker"),
)


def lines(count: int) -> Iterator[str]:
    """``count`` jobs of one tenant, then one of another, on each database."""
    job = Submission(image=scripted_image({"seconds": JOB_S}), request=json.dumps(REQUEST))
    rows: list[tuple[str, ...]] = []
    for database in ("SQLite", "Postgres"):
        waited, all_took = _waited(database, job, count)
        rows.append((database, f"{waited:.1f}", f"{all_took:.1f}"))
    yield from table_lines(
        f"{count} faked fits of {JOB_S:g} s in {SLOTS} slots, and one of another tenant",
        ("database", "the single one waits, s", "all are done after, s"),
        rows,
    )
    yield from note_lines(
        "From acceptance to the beginning, as the service records them. In the order of their "
        f"coming it would be {(count - FIRST_OF_THE_OTHERS) * JOB_S / SLOTS:g} s."
    )


def _waited(database: str, job: Submission, count: int) -> tuple[float, float]:
    with contextlib.ExitStack() as stack:
        folder = stack.enter_context(tempfile.TemporaryDirectory(prefix="maquette-benchmark-"))
        url = stack.enter_context(fresh_database()) if database == "Postgres" else None
        deployment = Deployment(
            folder=Path(folder),
            commands=FAKED,
            database_url=url,
            settings={"worker_processes": SLOTS, "authentication": "keys"},
            workers=0,
        )
        stack.enter_context(running(deployment))
        with httpx.Client(base_url=deployment.address, timeout=120) as probing:
            ready(probing)
        engine = open_database(
            url or f"sqlite:///{deployment.folder / 'maquette.sqlite'}", connections=1
        )
        keys = {tenant: KeyRing(engine).create(tenant) for tenant in ("many", "single")}
        engine.dispose()
        many, single = (
            stack.enter_context(
                httpx.Client(
                    base_url=deployment.address,
                    timeout=120,
                    headers={"Authorization": f"Bearer {key}"},
                )
            )
            for key in keys.values()
        )
        for client in (many, single):
            ready(client, "/v1/fits")
        began = time.monotonic()
        paths = [_posted(many, job) for _ in range(count)]
        while _begun(many, paths) < FIRST_OF_THE_OTHERS:
            time.sleep(0.05)
        waiting = _posted(single, job)
        all_ended(single, [waiting])
        waited_s = _waited_s(single.get(waiting).raise_for_status().json())
        all_ended(many, paths)
        return waited_s, time.monotonic() - began


def _waited_s(job: dict[str, Any]) -> float:
    created, started = (datetime.fromisoformat(job[key]) for key in ("created_at", "started_at"))
    return (started - created).total_seconds()


def _posted(client: httpx.Client, job: Submission) -> str:
    return client.post("/v1/fits", files=job.files).raise_for_status().headers["Location"]


def _begun(client: httpx.Client, paths: list[str]) -> int:
    return sum(
        client.get(path).raise_for_status().json()["state"] != "queued"
        for path in paths[:FIRST_OF_THE_OTHERS]
    )
