"""What the service takes beside the fits: the same fits through it and in a bare loop, in turns."""

import tempfile
import time
from collections.abc import Iterator
from dataclasses import dataclass
from multiprocessing import get_context
from multiprocessing.connection import Connection
from pathlib import Path

import httpx

from fitter.training.report.survey_comparison import note_lines, table_lines
from tests.benchmarks.served import NO_WORKER, ready, running, used_s
from tests.deployment import Deployment, Kind
from tests.submissions import Submission, small_submissions

ROUNDS = 3
PICTURES = 4
MAX_PIXELS = 10**7


@dataclass(frozen=True, slots=True, kw_only=True)
class _Taken:
    """Wall seconds, and processor seconds by who used them."""

    wall_s: float
    fits_s: float
    worker_s: float = 0.0
    api_s: float = 0.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Round:
    """The same fits both ways."""

    bare: _Taken
    served: _Taken

    @property
    def served_share(self) -> float:
        """The rate through the service over that of the bare loop."""
        return self.bare.wall_s / self.served.wall_s


def lines(count: int) -> Iterator[str]:
    """``count`` fits each way, in each of three rounds; one fit at a time."""
    rows = [
        (f"round {number}", *_cells(count, each))
        for number, each in enumerate(measured(count), start=1)
    ]
    yield from table_lines(
        f"{count} small fits by silhouette and edges, with their files, one at a time",
        (
            "",
            "bare, fits a s",
            "served",
            "share",
            "bare, processor s a fit",
            "served: the fit",
            "worker",
            "API",
        ),
        rows,
    )
    yield from note_lines(
        "Bare: a loop over the worker's own pipeline in one process. Served: from the first POST "
        "to the last result, the queue never empty. Worker and API look at the database ten times "
        "a second, so that a busy machine, on which a fit takes longer, charges them more."
    )


def measured(count: int) -> list[Round]:
    """Rounds of ``count`` fits each way, after a few untimed ones."""
    submissions = small_submissions(count)
    ours, theirs = get_context("spawn").Pipe()
    loop = get_context("spawn").Process(target=_loop, args=(theirs,))
    loop.start()
    ours.send(submissions[:PICTURES])
    ours.recv()
    rounds: list[Round] = []
    with tempfile.TemporaryDirectory(prefix="maquette-benchmark-") as folder:
        deployment = Deployment(folder=Path(folder), commands=NO_WORKER, workers=1)
        with running(deployment), httpx.Client(base_url=deployment.address, timeout=120) as client:
            ready(client)
            _serve(deployment, client, submissions[:PICTURES])
            for _ in range(ROUNDS):
                ours.send(submissions)
                bare: _Taken = ours.recv()
                served = _serve(deployment, client, submissions)
                rounds.append(Round(bare=bare, served=served))
    ours.send([])
    loop.join()
    return rounds


def _cells(count: int, each: Round) -> tuple[str, ...]:
    bare, served = each.bare, each.served
    return (
        f"{count / bare.wall_s:.2f}",
        f"{count / served.wall_s:.2f}",
        f"{100 * each.served_share:.0f} %",
        f"{bare.fits_s / count:.3f}",
        f"{served.fits_s / count:.3f}",
        f"{served.worker_s / count:.3f}",
        f"{served.api_s / count:.3f}",
    )


def _serve(deployment: Deployment, client: httpx.Client, submissions: list[Submission]) -> _Taken:
    used, began = _used(deployment), time.monotonic()
    paths = [
        client.post("/v1/fits", files=each.files).raise_for_status().headers["Location"]
        for each in submissions
    ]
    for path in paths:
        with client.stream("GET", f"{path}/events", timeout=None) as events:
            assert any('"state":"succeeded"' in line for line in list(events.iter_lines()))
    wall_s, end = time.monotonic() - began, _used(deployment)
    fits_s, worker_s, api_s = (after - before for after, before in zip(end, used, strict=True))
    return _Taken(wall_s=wall_s, fits_s=fits_s, worker_s=worker_s, api_s=api_s)


def _used(deployment: Deployment) -> list[float]:
    return [used_s(deployment, kind) for kind in (Kind.FIT, Kind.WORKER, Kind.API)]


def _loop(answer: Connection) -> None:
    from api_schemas.fit import FitRequest
    from service.compute.pipeline import fit_task
    from service.compute.tasks import OPTIONS, ChildSetup
    from service.jobs.inputs import SentPicture, named_pictures
    from service.submissions.submission import check_submission

    setup = ChildSetup(name="job", max_pixels=MAX_PIXELS)
    while submissions := answer.recv():
        used, began = time.process_time(), time.monotonic()
        for each in submissions:
            asked = FitRequest.model_validate_json(each.request)
            pictures = (SentPicture(each.image, None),)
            checked = check_submission(asked, pictures, max_pixels=MAX_PIXELS)
            parts = {
                OPTIONS: checked.request.model_dump_json().encode(),
                **named_pictures(pictures),
            }
            fit_task(setup, parts, lambda _: None)
        answer.send(_Taken(wall_s=time.monotonic() - began, fits_s=time.process_time() - used))
