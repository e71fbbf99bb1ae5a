"""How quickly the API answers with a full queue, 200 listeners to events and 50 polling callers."""

import tempfile
import time
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path

import httpx
import numpy as np

from fitter.training.report.text_tables import note_lines, table_lines
from tests.benchmarks.crowd import crowd
from tests.benchmarks.served import NO_WORKER, ready, running
from tests.deployment import Deployment, Kind
from tests.process_table import processor_s
from tests.submissions import small_submissions

LISTENERS = 200
POLLERS = 50
PROBES = 300
PICTURES = 4


def lines(count: int) -> Iterator[str]:
    """``count`` jobs wait; then a worker begins, and the same is measured again."""
    submissions = small_submissions(PICTURES)
    with tempfile.TemporaryDirectory(prefix="maquette-benchmark-") as folder:
        deployment = Deployment(
            folder=Path(folder),
            commands=NO_WORKER,
            # Room for the last row's, however slowly fits make some.
            settings={"max_queued": count + PROBES},
            workers=0,
        )
        with running(deployment), httpx.Client(base_url=deployment.address, timeout=120) as client:
            ready(client, "/healthz/live")
            rows: list[tuple[str, ...]] = []
            paths: list[str] = []

            def post() -> None:
                answer = client.post("/v1/fits", files=submissions[len(paths) % PICTURES].files)
                paths.append(answer.raise_for_status().headers["Location"])

            def get() -> None:
                client.get(paths[len(paths) // 2]).raise_for_status()

            post()
            rows.append(_row("GET, nothing else going on", get, PROBES, deployment))
            rows.append(_row("POST, queue empty to a tenth", post, count // 10, deployment))
            while len(paths) < count - count // 10:
                post()
            rows.append(_row(f"POST, to {count} waiting", post, count - len(paths), deployment))
            rows.append(_row(f"GET, {count} waiting", get, PROBES, deployment))
            with crowd(deployment.port, listening_to=paths[:LISTENERS], polling=paths[-POLLERS:]):
                time.sleep(5.0)
                rows.append(_row("GET, and the crowd", get, PROBES, deployment))
                deployment.start_worker()
                ready(client, "/healthz/ready")
                rows.append(_row("GET, the crowd, fits running", get, PROBES, deployment))
                rows.append(_row("POST, the crowd, fits running", post, PROBES // 3, deployment))
    yield from table_lines(
        f"`maquette serve`, SQLite; crowd: {LISTENERS} listeners to events, {POLLERS} pollers "
        "once a second; ms",
        ("", "median", "99 %", "API's processor a request"),
        rows,
    )
    yield from note_lines(
        "Latencies of one caller, one request after the other, in a process beside the crowd's. "
        "The API's processor time is all it used meanwhile, the crowd's requests included."
    )


def _row(
    name: str, request: Callable[[], None], times: int, deployment: Deployment
) -> tuple[str, ...]:
    (api,) = deployment.of_kind(Kind.API)
    before = processor_s(api.pid)
    seconds = [_timed(request) for _ in range(times)]
    used = processor_s(api.pid) - before
    return (name, *_quantiles_ms(seconds), f"{1e3 * used / times:.1f}")


def _timed(request: Callable[[], None]) -> float:
    began = time.perf_counter()
    request()
    return time.perf_counter() - began


def _quantiles_ms(seconds: Sequence[float]) -> tuple[str, str]:
    return f"{1e3 * np.median(seconds):.1f}", f"{1e3 * np.percentile(seconds, 99.0):.1f}"
