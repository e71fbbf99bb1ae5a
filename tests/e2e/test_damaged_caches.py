"""Caches that are damaged while a service runs, and between two runs."""

import os
import sys
from collections.abc import Callable
from pathlib import Path

import httpx

from tests.e2e.service import REPOSITORY, ended_job, started_service, wait_until_ready
from tests.submissions import small_submissions


def fit(client: httpx.Client) -> dict:
    (sent,) = small_submissions(1)
    return ended_job(client, client.post("/v1/fits", files=sent.files))


def test_files_damaged_at_any_time_are_made_anew_and_jobs_succeed(tmp_path: Path):
    caches = tmp_path / "caches"
    command = (sys.executable, "-m", "service.cli", "serve", "--port", "0")
    command += ("--data-dir", str(tmp_path / "data"))
    environment = os.environ | {"FITTER_CACHE_DIR": str(caches)}

    def damage(change: Callable[[Path], object]) -> None:
        found = list(caches.glob("*.prepared"))
        assert len(found) == 2
        for path in found:
            change(path)

    with started_service(command, cwd=REPOSITORY, environment=environment) as client:
        wait_until_ready(client)
        assert fit(client)["state"] == "succeeded"
        # Under what is mapped: every process that reads it dies.
        damage(lambda path: path.write_bytes(b""))
        job = fit(client)
        assert job["state"] == "succeeded"
        assert job["attempt"] > 1
    damage(lambda path: path.write_bytes(bytes(path.stat().st_size)))
    with started_service(command, cwd=REPOSITORY, environment=environment) as client:
        wait_until_ready(client)
        assert fit(client)["state"] == "succeeded"
