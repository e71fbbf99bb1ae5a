"""``maquette demo``: a whole fit over HTTP, from starting the service to the files on disk."""

import re
import subprocess
import tempfile
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import IO, Final

import httpx

from api_schemas.jobs import EventData, EventKind, Fit, JobState
from api_schemas.problems import PROBLEM_MEDIA_TYPE, Problem
from api_schemas.results import FitResult
from service.commands.terminal import Stages, print_problem, print_result
from service.demo_data.sample import Sample, load_sample
from service.process.supervisor import PYTHON

SERVE_COMMAND: Final = (*PYTHON, "-m", "service.cli", "serve", "--port", "0")
START_TIMEOUT_S: Final = 240.0
"""A guard against hanging: a worker is there in a few seconds. The fit waits for what is to be
compiled, however long that takes."""

READY_POLL_S: Final = 0.05


class ServiceStartError(Exception):
    """The service did not come up; the message says where its log is."""


def run_demo(
    output: Path,
    *,
    sample: Sample | None = None,
    serve_command: Sequence[str] = SERVE_COMMAND,
) -> int:
    """Start a service, post the sample, follow it, print and keep what comes; return the status."""
    started = time.monotonic()
    sample = sample or load_sample()
    output.mkdir(parents=True, exist_ok=True)
    with (
        tempfile.TemporaryDirectory(prefix="maquette-demo-") as data_dir,
        (output / "service.log").open("w") as log,
        running_service(serve_command, Path(data_dir), log) as client,
    ):
        print(f"The service listens on {client.base_url} ({time.monotonic() - started:.1f} s).")
        accepted = _submit(client, sample)
        ended = _follow(client, accepted)
        if ended.problem is not None or ended.state is not JobState.SUCCEEDED:
            _tell_failure(ended)
            return 1
        result = _keep_files(client, ended, output)
    print_result(result, truth=sample.truth)
    print(
        f"{time.monotonic() - started:.1f} s from start to result. The pictures (overlay.png, "
        "segmentation.png, albedo.png, shading.png ...) and the posed body lie in "
        f"{output}/views/0, the body (body_canonical.glb) and result.json in {output}."
    )
    return 0


@contextmanager
def running_service(command: Sequence[str], data_dir: Path, log: IO[str]) -> Iterator[httpx.Client]:
    """A service of one's own with its data in a folder, and a client of it once it has a worker."""
    with subprocess.Popen(
        [*command, "--data-dir", str(data_dir)], stdout=subprocess.PIPE, stderr=log, text=True
    ) as process:
        try:
            with httpx.Client(base_url=_address(process), timeout=30.0) as client:
                _wait_for_worker(client, process)
                yield client
        finally:
            process.terminate()


def _address(process: subprocess.Popen[str]) -> str:
    assert process.stdout is not None
    for line in process.stdout:
        found = re.search(r"http://\S+:\d+", line)
        if found:
            return found[0]
    message = "The service ended before it listened; see service.log in the output folder."
    raise ServiceStartError(message)


def _wait_for_worker(client: httpx.Client, process: subprocess.Popen[str]) -> None:
    deadline = time.monotonic() + START_TIMEOUT_S
    while time.monotonic() < deadline and process.poll() is None:
        try:
            if client.get("/v1/body-models").status_code == httpx.codes.OK:
                return
        except httpx.TransportError:
            pass
        time.sleep(READY_POLL_S)
    message = "The service did not get ready; see service.log in the output folder."
    raise ServiceStartError(message)


def _submit(client: httpx.Client, sample: Sample) -> Fit:
    response = client.post(
        "/v1/fits",
        files={
            "image": ("sample.jpg", sample.image, "image/jpeg"),
            "request": ("request.json", sample.request, "application/json"),
        },
    )
    if response.headers["content-type"] == PROBLEM_MEDIA_TYPE:
        raise ServiceStartError(Problem.model_validate_json(response.content).detail)
    return Fit.model_validate_json(response.content)


def _follow(client: httpx.Client, fit: Fit) -> Fit:
    stages = Stages()
    with client.stream("GET", fit.links.events, timeout=None) as response:
        for _, data in _events(response):
            stages.show(data.stage, data.progress)
    return Fit.model_validate_json(client.get(fit.links.self).content)


def _events(response: httpx.Response) -> Iterator[tuple[EventKind, EventData]]:
    fields: dict[str, str] = {}
    for line in response.iter_lines():
        if line:
            name, _, value = line.partition(": ")
            fields[name] = value
        elif "data" in fields:
            yield EventKind(fields["event"]), EventData.model_validate_json(fields["data"])
            fields = {}


def _keep_files(client: httpx.Client, fit: Fit, output: Path) -> FitResult:
    for name, path in fit.links.files.items():
        file = output / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_bytes(client.get(path).raise_for_status().content)
    assert fit.links.result is not None
    return FitResult.model_validate_json(client.get(fit.links.result).content)


def _tell_failure(fit: Fit) -> None:
    print(f"The fit {fit.state}.")
    if fit.problem is not None:
        print_problem(fit.problem)
