"""Those who look at the service every second: a load balancer, Prometheus, a page's list."""

import contextlib
import threading
import time
from collections.abc import Iterator
from dataclasses import dataclass, field

import httpx

from tests.chaos.outages.client import HANG_S
from tests.chaos.outages.exchanges import Ledger

EVERY_S = 1.0
PATHS = {
    "GET live": "/healthz/live",
    "GET ready": "/healthz/ready",
    "GET metrics": "/metrics",
    "GET list": "/v1/fits?limit=1",
}


@dataclass(slots=True)
class Probes:
    """The figures of ``/metrics`` as they were seen, with their moments."""

    figures: list[tuple[float, dict[str, float]]] = field(
        default_factory=list[tuple[float, dict[str, float]]]
    )

    def latest(self, name: str) -> float | None:
        """The last value of a metric without labels; None if it was not told then."""
        return self.figures[-1][1].get(name) if self.figures else None


@contextlib.contextmanager
def probing(address: str, ledger: Ledger) -> Iterator[Probes]:
    """Look every second, each path by a thread of its own, so that none waits for another."""
    probes, stopped = Probes(), threading.Event()
    threads = [
        threading.Thread(target=_probe, args=(address, what, path, ledger, probes, stopped))
        for what, path in PATHS.items()
    ]
    for thread in threads:
        thread.start()
    try:
        yield probes
    finally:
        stopped.set()
        for thread in threads:
            thread.join()


def _probe(
    address: str, what: str, path: str, ledger: Ledger, probes: Probes, stopped: threading.Event
) -> None:
    with httpx.Client(base_url=address, timeout=HANG_S) as client:
        while not stopped.wait(EVERY_S):
            answer = ledger.send(what, lambda: client.get(path))
            if what == "GET metrics":
                text = answer.text if answer is not None and answer.is_success else ""
                probes.figures.append((time.monotonic(), _values(text)))


def _values(text: str) -> dict[str, float]:
    lines = (line.split() for line in text.splitlines() if not line.startswith("#"))
    return {line[0]: float(line[1]) for line in lines if len(line) > 1 and "{" not in line[0]}
