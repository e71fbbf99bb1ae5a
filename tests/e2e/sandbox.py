"""The real service as a sandbox, and what a client developer asks of it."""

import contextlib
import json
import os
import sys
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import httpx

from service.demo_data.sample import load_sample, load_scan_sample
from tests.e2e.service import (
    REPOSITORY,
    ended_job,
    started_service,
    wait_for_estimator,
    wait_until_ready,
)


@contextlib.contextmanager
def running_sandbox(
    data_dir: Path, *, key: str | None = None, **settings: object
) -> Iterator[httpx.Client]:
    """Start API and worker as a sandbox on an empty data folder; stop them at the end."""
    named = {f"MAQUETTE_{name.upper()}": str(value) for name, value in settings.items()}
    command = (sys.executable, "-m", "service.cli", "serve", "--port", "0")
    with started_service(
        [*command, "--data-dir", str(data_dir)],
        cwd=REPOSITORY,
        environment={**os.environ, "MAQUETTE_SANDBOX": "true", **named},
    ) as client:
        if key is not None:
            client.headers["Authorization"] = f"Bearer {key}"
        wait_until_ready(client)
        wait_for_estimator(client)
        yield client


def posted_fit(client: httpx.Client, picture: bytes, **changed: object) -> httpx.Response:
    """Post a fit of any picture as large as the sample's."""
    request = json.loads(load_sample().request) | changed
    return client.post(
        "/v1/fits",
        files={"image": ("picture", picture)},
        data={"request": json.dumps(request)},
    )


def posted_scan(
    client: httpx.Client, picture: bytes, *, views: tuple[str, ...], **changed: object
) -> httpx.Response:
    """Post a scan with the same picture for all views."""
    request = json.loads(load_scan_sample().request)
    points = request["views"][0]["points"]
    request["views"] = [{"view": view, "points": points} for view in views]
    return client.post(
        "/v1/scans",
        files={f"image_{number}": ("picture", picture) for number in range(len(views))},
        data={"request": json.dumps(request | changed)},
    )


def fitted(client: httpx.Client, picture: bytes, **changed: object) -> dict[str, Any]:
    """A fit that has ended."""
    return ended_job(client, posted_fit(client, picture, **changed))


def scanned(client: httpx.Client, picture: bytes, **changed: Any) -> dict[str, Any]:
    """A scan that has ended."""
    return ended_job(client, posted_scan(client, picture, **changed))


def derived(client: httpx.Client, job: Mapping[str, Any], **asked: object) -> dict[str, Any]:
    """What was derived from a job, ended."""
    return ended_job(client, client.post(job["links"]["derivations"], json=asked))


def result_of(client: httpx.Client, job: Mapping[str, Any]) -> dict[str, Any]:
    """The result of a job that has succeeded."""
    assert job["state"] == "succeeded", job["problem"]
    return client.get(job["links"]["result"]).raise_for_status().json()
