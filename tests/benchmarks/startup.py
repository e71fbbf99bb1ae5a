"""What a start takes: `maquette serve` on a new data folder, until it answers and has fitted."""

import contextlib
import tempfile
import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import httpx

from fitter.training.report.text_tables import note_lines, table_lines
from tests.benchmarks.served import all_ended, running, used_s
from tests.deployment import Deployment, Kind
from tests.submissions import Submission, small_submissions

LOOK_S = 0.01
WITHIN_S = 300.0


def lines(count: int) -> Iterator[str]:
    """``count`` starts, one after the other, and one before them that is not counted."""
    (submission,) = small_submissions(1)
    _start(submission)
    starts = [_start(submission) for _ in range(count)]
    yield from table_lines(
        f"{count} starts, seconds from the command",
        ("", "answers", "ready", "first fit's end", "processor s until ready", "until the fit"),
        [(f"start {number}", *_cells(start)) for number, start in enumerate(starts, start=1)],
    )
    yield from note_lines(
        "The start that is not counted compiles the kernels if they are not yet. "
        "Answers: /healthz/live. The fit, a small one, is posted once /healthz/ready is 200, and "
        "waits for the numerics. Processor seconds are those of all processes that are still there."
    )


@dataclass(frozen=True, slots=True, kw_only=True)
class _Start:
    """Seconds since the command, and processor seconds used by then."""

    answers_s: float
    ready_s: float
    fitted_s: float
    used_until_ready_s: float
    used_until_fitted_s: float


def _start(submission: Submission) -> _Start:
    with tempfile.TemporaryDirectory(prefix="maquette-benchmark-") as folder:
        deployment = Deployment(folder=Path(folder), workers=0)
        began = time.monotonic()
        with running(deployment), httpx.Client(base_url=deployment.address, timeout=120) as client:
            _wait_for(client, "/healthz/live")
            answers_s = time.monotonic() - began
            _wait_for(client, "/healthz/ready")
            ready_s = time.monotonic() - began
            used_until_ready_s = _used_s(deployment)
            posted = client.post("/v1/fits", files=submission.files).raise_for_status()
            all_ended(client, [posted.headers["Location"]])
            return _Start(
                answers_s=answers_s,
                ready_s=ready_s,
                fitted_s=time.monotonic() - began,
                used_until_ready_s=used_until_ready_s,
                used_until_fitted_s=_used_s(deployment),
            )


def _wait_for(client: httpx.Client, probe: str) -> None:
    deadline = time.monotonic() + WITHIN_S
    while time.monotonic() < deadline:
        with contextlib.suppress(httpx.TransportError):
            if client.get(probe).status_code == httpx.codes.OK:
                return
        time.sleep(LOOK_S)
    message = f"{probe} did not answer with 200 within {WITHIN_S:g} s"
    raise TimeoutError(message)


def _used_s(deployment: Deployment) -> float:
    return sum(used_s(deployment, kind) for kind in Kind)


def _cells(start: _Start) -> tuple[str, ...]:
    return (
        f"{start.answers_s:.2f}",
        f"{start.ready_s:.2f}",
        f"{start.fitted_s:.2f}",
        f"{start.used_until_ready_s:.1f}",
        f"{start.used_until_fitted_s:.1f}",
    )
