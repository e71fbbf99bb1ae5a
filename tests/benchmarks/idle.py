"""Memory of a service that waits: every process of `maquette serve`, and all of them together."""

import tempfile
import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from statistics import median

import httpx

from fitter.training.report.survey_comparison import note_lines, table_lines
from tests.benchmarks.served import ready, running
from tests.deployment import Deployment, Kind
from tests.e2e.service import wait_for_estimator
from tests.process_table import Process, memory_mib

SETTLED_S = 5.0
"""From the estimator's first answer: by then the processes that prepare something have ended."""

FIELDS = ("Rss", "Pss", "Pss_Anon", "Pss_File")
ALL = "all"


@dataclass(frozen=True, slots=True, kw_only=True)
class _Use:
    """What a process, or all of them, has of each of ``FIELDS``, MiB."""

    name: str
    mib: tuple[float, ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class Idle:
    """A service that waits."""

    processes: tuple[_Use, ...]

    @property
    def together(self) -> _Use:
        """All processes."""
        columns = zip(*(each.mib for each in self.processes), strict=True)
        return _Use(name=ALL, mib=tuple(sum(values) for values in columns))

    @property
    def share_mib(self) -> float:
        """The sum of their shares."""
        return self.together.mib[FIELDS.index("Pss")]


def lines(count: int) -> Iterator[str]:
    """``count`` services, one after the other; the processes shown are those of the last."""
    services = measured(count)
    last = services[-1]
    yield from table_lines(
        "Processes of `maquette serve` with one worker, idle, MiB",
        ("", "resident", "its share", "of no file", "of files"),
        [
            (each.name, *(f"{value:.0f}" for value in each.mib))
            for each in (*last.processes, last.together)
        ],
    )
    shares = [each.share_mib for each in services]
    yield from note_lines(
        f"All shares in {count} services: median {median(shares):.0f}, {min(shares):.0f} to "
        f"{max(shares):.0f}. A share counts pages that several processes have by their number: "
        "other programs that use the same libraries make the part of files less."
    )


def measured(count: int) -> list[Idle]:
    """``count`` services, one after the other."""
    return [_idle() for _ in range(count)]


def _idle() -> Idle:
    """The processes of a service that has answered once."""
    with tempfile.TemporaryDirectory(prefix="maquette-benchmark-") as folder:
        deployment = Deployment(folder=Path(folder), workers=0)
        with running(deployment), httpx.Client(base_url=deployment.address, timeout=120) as client:
            ready(client)
            wait_for_estimator(client)
            time.sleep(SETTLED_S)
            return Idle(
                processes=tuple(
                    _Use(name=_name(each, deployment), mib=memory_mib(each.pid, FIELDS))
                    for each in deployment.processes()
                )
            )


def _name(process: Process, deployment: Deployment) -> str:
    kinds = (kind for kind in Kind if process in deployment.of_kind(kind))
    return next((kind.value for kind in kinds), process.command.split()[-1])
