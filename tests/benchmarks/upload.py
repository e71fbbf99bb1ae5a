"""A photograph of twelve megapixels through the real service: from upload to result."""

import os
import tempfile
import time
from collections.abc import Iterator, Sequence
from pathlib import Path

import httpx

from fitter.fits.progress import Stage
from fitter.request import FitRequest
from fitter.training.report.text_tables import note_lines, table_lines
from tests.benchmarks.requests import suite_requests
from tests.benchmarks.spent import late, median
from tests.e2e.service import running_service
from tests.submissions import submission

SIZE = (3000, 4000)
_WARMING = 1
_QUIET = {"MAQUETTE_LOG_LEVEL": "WARNING"}


def lines(count: int) -> Iterator[str]:
    """``count`` fits one after the other, wall time as a caller sees it."""
    requests = suite_requests(count + _WARMING, width=SIZE[0], height=SIZE[1])
    posted = measured(requests)
    names = ("accepted", "result there", "everything fetched", *(stage.value for stage in Stage))
    rows = [
        (name, f"{median(values):.2f}", f"{late(values):.2f}")
        for name in names
        if (values := [each[name] for each in posted if name in each])
    ]
    size = sum(len(request.views[0].image) for request in requests) / len(requests) / 1e6
    yield from table_lines(
        f"`maquette serve` on loopback, {count} photographs of {SIZE[0]}x{SIZE[1]} "
        f"({size:.1f} MB JPEG), wall seconds",
        ("", "median", "95 %"),
        rows,
    )
    yield from note_lines(
        "The first three are counted from the start of the upload; the stages are the fit's own "
        "account of itself; pictures and meshes are made after them."
    )


def measured(requests: Sequence[FitRequest]) -> list[dict[str, float]]:
    """What each upload took, by what was waited for; the first warms up and is left out."""
    os.environ.update(_QUIET)
    with (
        tempfile.TemporaryDirectory(prefix="maquette-benchmark-") as folder,
        running_service(Path(folder)) as client,
    ):
        return [_posted(client, request) for request in requests][_WARMING:]


def _posted(client: httpx.Client, request: FitRequest) -> dict[str, float]:
    began = time.perf_counter()
    response = client.post("/v1/fits", files=submission(request).files).raise_for_status()
    job = response.json()
    accepted = time.perf_counter() - began
    with client.stream("GET", job["links"]["events"], timeout=None) as events:
        for _ in events.iter_lines():
            pass
    done = time.perf_counter() - began
    job = client.get(job["links"]["self"]).raise_for_status().json()
    assert job["state"] == "succeeded", job
    result = client.get(job["links"]["result"]).raise_for_status().json()
    for path in job["links"]["files"].values():
        client.get(path).raise_for_status()
    return {
        "accepted": accepted,
        "result there": done,
        "everything fetched": time.perf_counter() - began,
    } | dict(result["stage_seconds"])
