"""How soon a canceled fit uses no processor any more."""

import tempfile
import time
from collections.abc import Iterator
from pathlib import Path

import httpx

from fitter.training.report.text_tables import note_lines, table_lines
from tests.benchmarks.served import NO_WORKER, ready, running
from tests.benchmarks.spent import late, median
from tests.deployment import Deployment, Kind
from tests.process_table import is_running
from tests.submissions import Submission, small_submissions

LOOK_S = 0.002
STAGE_BEGUN = "segmentation"


def lines(count: int) -> Iterator[str]:
    """``count`` fits canceled in the middle."""
    (submission,) = small_submissions(1)
    with tempfile.TemporaryDirectory(prefix="maquette-benchmark-") as folder:
        deployment = Deployment(folder=Path(folder), commands=NO_WORKER, workers=1)
        with running(deployment), httpx.Client(base_url=deployment.address, timeout=120) as client:
            ready(client)
            seconds = [_idle_after_s(deployment, client, submission) for _ in range(count)]
    yield from table_lines(
        f"{count} real fits canceled while they ran, wall seconds from the request to cancel",
        ("", "median", "95 %", "longest"),
        [("to the end of their process", *(f"{f(seconds):.2f}" for f in (median, late, max)))],
    )
    yield from note_lines("The process is gone, so that it uses no processor; the goal is 0.5 s.")


def _idle_after_s(deployment: Deployment, client: httpx.Client, submission: Submission) -> float:
    answer = client.post("/v1/fits", files=submission.files).raise_for_status()
    path = answer.headers["Location"]
    while client.get(path).json()["stage"] != STAGE_BEGUN:
        time.sleep(LOOK_S)
    fits = [process.pid for process in deployment.of_kind(Kind.FIT)]
    began = time.perf_counter()
    client.post(f"{path}/cancel").raise_for_status()
    while any(is_running(pid) for pid in fits):
        time.sleep(LOOK_S)
    return time.perf_counter() - began
