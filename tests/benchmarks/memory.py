"""Memory of a process that makes fits, and of a worker's child that waits."""

import re
from collections.abc import Callable, Iterator
from multiprocessing import get_context
from multiprocessing.connection import Connection
from pathlib import Path

from fitter.request import FitRequest
from fitter.training.report.text_tables import note_lines, table_lines

PRELOADED = "service.worker.preload"
"""What the worker's fork server imports before it forks."""

LARGE = (3000, 4000)
_KIB_PER_MIB = 1024.0


def lines(_: int) -> Iterator[str]:
    """Peaks of fresh processes, then shares of a forked child."""
    rows = [
        ("interpreter with the fitter imported", _fresh(_imported)),
        ("  and one gender's model prepared", _fresh(_prepared)),
        ("  and one fit, 480x640", _fresh(_fitted_small)),
        ("  and one fit, 3000x4000", _fresh(_fitted_large)),
    ]
    yield from table_lines(
        "Peak resident memory of a fresh process, MiB",
        ("", "peak"),
        [(name, f"{peak:.0f}") for name, peak in rows],
    )
    context = get_context("forkserver")
    context.set_forkserver_preload([PRELOADED])
    columns = ("Rss", "Pss", "Private")
    # The first child finds a server that is still importing.
    _asked(context.Process, context.Pipe, _shares_idle)
    rows = [
        (name, *(f"{shares[column]:.0f}" for column in columns))
        for name, shares in (
            ("idle", _asked(context.Process, context.Pipe, _shares_idle)),
            ("after one fit, 480x640", _asked(context.Process, context.Pipe, _shares_fitted)),
        )
    ]
    yield from table_lines(
        "Worker's child, forked from a server that has both models loaded, MiB",
        ("", "resident", "its share", "its own"),
        rows,
    )
    yield from note_lines(
        "Its share counts pages that several processes have by their number; its own are those "
        "it has alone."
    )


def _fresh(work: Callable[[Connection], None]) -> float:
    context = get_context("spawn")
    return _asked(context.Process, context.Pipe, work)


def _asked(process: Callable, pipe: Callable, work: Callable[[Connection], None]):
    ours, theirs = pipe()
    child = process(target=work, args=(theirs,))
    child.start()
    theirs.close()
    answer = ours.recv()
    child.join()
    return answer


def _peak_mib() -> float:
    """VmHWM and not ru_maxrss, which a child inherits from the process that starts it."""
    return _status_kib("/proc/self/status", "VmHWM") / _KIB_PER_MIB


def _status_kib(path: str, field: str) -> float:
    found = re.findall(rf"^{field}:\s+(\d+) kB", Path(path).read_text(), flags=re.MULTILINE)
    return float(found[0])


def _shares() -> dict[str, float]:
    rollup = "/proc/self/smaps_rollup"
    private = sum(_status_kib(rollup, field) for field in ("Private_Clean", "Private_Dirty"))
    return {
        "Rss": _status_kib(rollup, "Rss") / _KIB_PER_MIB,
        "Pss": _status_kib(rollup, "Pss") / _KIB_PER_MIB,
        "Private": private / _KIB_PER_MIB,
    }


def _request(width: int, height: int) -> FitRequest:
    from tests.benchmarks.requests import suite_requests

    return suite_requests(1, width=width, height=height)[0]


def _imported(answer: Connection) -> None:
    import fitter.fits.pipeline

    assert fitter.fits.pipeline.fit
    answer.send(_peak_mib())


def _prepared(answer: Connection) -> None:
    from fitter.fits.prepared_model import prepared_model
    from fitter.vocabulary.choices import Gender

    prepared_model(Gender.MALE)
    answer.send(_peak_mib())


def _fitted(width: int, height: int) -> None:
    from fitter.fits.pipeline import fit

    fit(_request(width, height))


def _fitted_small(answer: Connection) -> None:
    _fitted(480, 640)
    answer.send(_peak_mib())


def _fitted_large(answer: Connection) -> None:
    _fitted(*LARGE)
    answer.send(_peak_mib())


def _shares_idle(answer: Connection) -> None:
    answer.send(_shares())


def _shares_fitted(answer: Connection) -> None:
    _fitted(480, 640)
    answer.send(_shares())
