"""The same bits in processes that have run others, and in those that load compiled code."""

import json
from collections.abc import Iterator, Sequence

import pytest

from api_schemas.products import ProductRequest
from service.compute.fork_server import Child, ForkServer
from service.compute.messages import DoneMessage, ProgressMessage, TaskMessage
from service.compute.tasks import OPTIONS, PRODUCT, child_setup
from service.jobs.inputs import IMAGE, RESULT, of_view, product_inputs
from service.jobs.records import FIT
from service.settings import Settings
from tests.integration.service.harness import started_anew
from tests.submissions import checked, small_submissions

MAX_PIXELS = 10_000_000
SETUP = child_setup(Settings(max_pixels=MAX_PIXELS), name="job", tasks="service.compute.pipeline")

KINDS = ("caricature", "pose", "texture")

Job = tuple[str, dict[str, bytes]]
"""Its task and parts."""


@pytest.fixture(scope="module")
def processes() -> ForkServer:
    return started_anew(ForkServer("service.compute.preload"))


@pytest.fixture(scope="module")
def fits() -> Sequence[Job]:
    return [_fit(each.request, each.image) for each in small_submissions(2)]


@pytest.fixture(scope="module")
def alone(processes: ForkServer, fits: Sequence[Job]) -> dict[str, bytes]:
    """The files of the first fit, in a process of its own."""
    return next(results(processes, fits[:1]))


@pytest.fixture(scope="module")
def products(fits: Sequence[Job], alone: dict[str, bytes]) -> dict[str, Job]:
    """Products of the first fit, by kind."""
    files = product_inputs(fits[0][1] | alone)
    return {kind: _product({"kind": kind}, files) for kind in KINDS}


@pytest.fixture(scope="module")
def after_others(
    processes: ForkServer, fits: Sequence[Job], products: dict[str, Job]
) -> Sequence[dict[str, bytes]]:
    """The files of jobs that one process runs; the first fit is its second and its last."""
    one, other = fits
    return list(results(processes, [other, one, *products.values(), one]))


def test_a_fit_is_the_same_in_a_process_that_has_run_others(
    after_others: Sequence[dict[str, bytes]], alone: dict[str, bytes]
):
    assert after_others[1] == after_others[-1] == alone


@pytest.mark.parametrize("kind", KINDS)
def test_a_product_of_a_fit_is_the_same_after_other_jobs(
    processes: ForkServer,
    products: dict[str, Job],
    after_others: Sequence[dict[str, bytes]],
    kind: str,
):
    (alone,) = results(processes, [products[kind]])
    assert after_others[2 + KINDS.index(kind)] == alone


def results(processes: ForkServer, jobs: Sequence[Job]) -> Iterator[dict[str, bytes]]:
    """The files of jobs that one process runs, one after the other."""
    process = processes.start_child(SETUP)
    try:
        for task, parts in jobs:
            process.give(TaskMessage(task=task, parts=tuple(parts)), parts.values())
            yield _files(process)
    finally:
        process.end()


def _files(process: Child) -> dict[str, bytes]:
    while True:
        received = process.receive()
        assert received is not None
        if isinstance(received.message, DoneMessage):
            files = dict(received.parts)
            return files | {RESULT: _without_durations(files[RESULT])}
        assert isinstance(received.message, ProgressMessage), received.message


def _without_durations(document: bytes) -> bytes:
    result = json.loads(document)
    result.pop("stage_seconds", None)
    return json.dumps(result).encode()


def _fit(request: str, image: bytes) -> Job:
    asked = checked(request.encode(), image, max_pixels=MAX_PIXELS)
    return FIT, {OPTIONS: asked.model_dump_json().encode(), of_view(0, IMAGE): image}


def _product(options: dict[str, object], files: dict[str, bytes]) -> Job:
    options_part = ProductRequest.model_validate(options).model_dump_json().encode()
    return PRODUCT, {OPTIONS: options_part, **files}
