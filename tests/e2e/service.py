"""The real service, as a user starts it: `maquette serve` on a free port of the loopback."""

import contextlib
import re
import subprocess
import sys
import time
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path

import httpx

REPOSITORY = Path(__file__).parents[2]
READY_WITHIN_S = 600.0
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
    deadline = time.monotonic() + READY_WITHIN_S
    while time.monotonic() < deadline:
        with contextlib.suppress(httpx.TransportError):
            if client.get("/healthz/ready").status_code == httpx.codes.OK:
                return
        time.sleep(0.1)
    message = "the service did not get ready"
    raise AssertionError(message)


def wait_for_estimator(client: httpx.Client) -> None:
    """Wait for what answers bodies and initial poses."""
    deadline = time.monotonic() + READY_WITHIN_S
    while time.monotonic() < deadline:
        with contextlib.suppress(httpx.TransportError):
            if client.post("/v1/bodies", json={"gender": "male"}).status_code == httpx.codes.OK:
                return
        time.sleep(0.1)
    message = "the estimator did not get ready"
    raise AssertionError(message)


def ended_job(client: httpx.Client, response: httpx.Response) -> dict:
    """Poll a job to its end; a product may have been made by another test and be there at once."""
    if response.status_code == httpx.codes.OK:
        return response.json()
    assert response.status_code == httpx.codes.ACCEPTED, response.text
    path = response.headers["Location"]
    deadline = time.monotonic() + FIT_WITHIN_S
    while time.monotonic() < deadline:
        job = client.get(path).raise_for_status().json()
        if job["state"] not in {"queued", "running"}:
            return job
        time.sleep(0.2)
    message = f"{path} did not end"
    raise AssertionError(message)


def fits(client: httpx.Client) -> set[str]:
    """The ids of the newest fits there are."""
    return {each["id"] for each in client.get("/v1/fits").raise_for_status().json()["fits"]}
