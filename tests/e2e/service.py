"""The real service, as a user starts it: `maquette serve` on a free port of the loopback."""

import contextlib
import re
import subprocess
import sys
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import httpx

from tests.integration.service.harness import eventually

REPOSITORY = Path(__file__).parents[2]
FIT_WITHIN_S = 900.0
ANSWER_WITHIN_S = 180.0
"""Guards against hanging, on machines that are busy: what is there is not waited for."""


@contextlib.contextmanager
def running_service(data_dir: Path) -> Iterator[httpx.Client]:
    """Start API and worker on an empty data folder; stop them at the end."""
    maquette = (sys.executable, "-m", "service.cli")
    command = [*maquette, "serve", "--port", "0", "--data-dir", str(data_dir)]
    with started_service(command, cwd=REPOSITORY) as client:
        wait_until_ready(client)
        yield client


@contextlib.contextmanager
def started_service(
    command: Sequence[str], *, cwd: Path, environment: Mapping[str, str] | None = None
) -> Iterator[httpx.Client]:
    """Start a service by a command and wait until it listens; stop it at the end."""
    process = subprocess.Popen(command, cwd=cwd, env=environment, stdout=subprocess.PIPE, text=True)
    assert process.stdout is not None
    try:
        address = next(
            found[0] for line in process.stdout if (found := re.search(r"http://\S+:\d+", line))
        )
        with httpx.Client(base_url=address, timeout=ANSWER_WITHIN_S) as client:
            yield client
    finally:
        process.terminate()
        process.wait()
        process.stdout.close()


def wait_until_ready(client: httpx.Client) -> None:
    """Wait for the API and its worker."""
    eventually(lambda: _succeeds(client, "GET", "/healthz/ready"), what="API and worker")


def wait_for_estimator(client: httpx.Client) -> None:
    """Wait for what answers bodies and initial poses."""
    person = {"gender": "male"}
    eventually(lambda: _succeeds(client, "POST", "/v1/bodies", json=person), what="estimator")


def _succeeds(client: httpx.Client, method: str, path: str, **sent: Any) -> bool:
    with contextlib.suppress(httpx.TransportError):
        return client.request(method, path, **sent).status_code == httpx.codes.OK
    return False


def ended_job(client: httpx.Client, response: httpx.Response) -> dict:
    """Poll a job to its end; a product may have been made by another test and be there at once."""
    if response.status_code == httpx.codes.OK:
        return response.json()
    assert response.status_code == httpx.codes.ACCEPTED, response.text
    path = response.headers["Location"]

    def ended() -> dict | None:
        job = client.get(path).raise_for_status().json()
        return None if job["state"] in {"queued", "running"} else job

    return eventually(ended, within_s=FIT_WITHIN_S, what=f"{path} ended")


def fits(client: httpx.Client) -> set[str]:
    """The ids of the newest fits there are."""
    return {each["id"] for each in client.get("/v1/fits").raise_for_status().json()["fits"]}
