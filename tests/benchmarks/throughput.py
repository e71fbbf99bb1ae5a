"""Fits a second with one process and with several."""

import time
from collections.abc import Iterator, Mapping
from multiprocessing import get_context
from multiprocessing.connection import Connection
from multiprocessing.synchronize import Barrier

from fitter.fits.pipeline import fit
from fitter.training.report.survey_comparison import note_lines, table_lines
from tests.benchmarks.requests import suite_requests, warm_up

PROCESSES = (1, 2)


def lines(count: int) -> Iterator[str]:
    """``count`` fits by each process."""
    rates = measured(count)
    first = rates[PROCESSES[0]]
    rows = [
        (str(processes), f"{rate:.2f}", f"{rate / first:.2f}") for processes, rate in rates.items()
    ]
    yield from table_lines(
        f"Throughput, {count} fits a process, 480x640",
        ("processes", "fits a second", "times one"),
        rows,
    )
    yield from note_lines("Wall time from the first fit's start to the last one's end.")


def measured(count: int) -> Mapping[int, float]:
    """Fits a second by the number of processes, each of which makes ``count``."""
    return {processes: _fits_a_second(processes, count) for processes in PROCESSES}


def _fits_a_second(processes: int, count: int) -> float:
    context = get_context("spawn")
    together = context.Barrier(processes)
    pipes = [context.Pipe() for _ in range(processes)]
    children = [
        context.Process(target=_fit_many, args=(count, together, theirs)) for _, theirs in pipes
    ]
    for child in children:
        child.start()
    spans = [ours.recv() for ours, _ in pipes]
    for child in children:
        child.join()
    begin, end = min(span[0] for span in spans), max(span[1] for span in spans)
    return processes * count / (end - begin)


def _fit_many(count: int, together: Barrier, answer: Connection) -> None:
    warm_up()
    requests = suite_requests(count, width=480, height=640)
    together.wait()
    # One clock for all processes of a machine.
    begin = time.monotonic()
    for request in requests:
        fit(request)
    answer.send((begin, time.monotonic()))
