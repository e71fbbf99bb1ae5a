"""The service as benchmarks run it, and what its processes use."""

import contextlib
import time
from collections.abc import Iterator

import httpx

from tests.deployment import REAL, Commands, Deployment, Kind
from tests.process_table import processor_s

NO_WORKER = Commands(serve=(*REAL.serve, "--no-worker"), worker=REAL.worker)
READY_WITHIN_S = 300.0


@contextlib.contextmanager
def running(deployment: Deployment) -> Iterator[Deployment]:
    """Start a service, and end it afterwards."""
    try:
        deployment.start()
        yield deployment
    finally:
        deployment.end()


def ready(client: httpx.Client, probe: str = "/healthz/ready") -> None:
    """Wait until the service says that it is."""
    deadline = time.monotonic() + READY_WITHIN_S
    while time.monotonic() < deadline:
        with contextlib.suppress(httpx.TransportError):
            if client.get(probe).status_code == httpx.codes.OK:
                return
        time.sleep(0.2)
    message = f"{probe} did not answer with 200 within {READY_WITHIN_S:g} s"
    raise TimeoutError(message)


def used_s(deployment: Deployment, kind: Kind) -> float:
    """Processor seconds that the processes of a kind have used; of fits, those that ended too."""
    if kind is Kind.FIT:
        servers = deployment.of_kind(Kind.FORK_SERVER)
        ended = (
            processor_s(each.pid, with_ended_children=True) - processor_s(each.pid)
            for each in servers
        )
        return sum(ended) + sum(processor_s(each.pid) for each in deployment.of_kind(kind))
    return sum(processor_s(process.pid) for process in deployment.of_kind(kind))
