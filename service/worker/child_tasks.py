"""What a worker tells a child: once how to work, then for each job what to do and with what."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from multiprocessing.connection import Connection
from pathlib import Path

from service.process.logs import LogContext


@dataclass(frozen=True, slots=True, kw_only=True)
class ChildSetup:
    """What holds for all jobs of a child."""

    pipeline: str
    max_pixels: int
    models: Path | None
    detector: Path | None
    memory_mb: int
    log_level: str
    log_format: str


@dataclass(frozen=True, slots=True, kw_only=True)
class ChildTask:
    """A job; its options and named inputs follow as bytes.

    ``derived_from`` is the fit or scan a job derives from, None for one of these.
    """

    kind: str
    inputs: tuple[str, ...]
    log_context: LogContext
    derived_from: str | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class GivenTask:
    """A job as it has arrived."""

    task: ChildTask
    options: bytes
    inputs: Mapping[str, bytes]


def give(connection: Connection, task: ChildTask, parts: Iterable[bytes]) -> None:
    """Send a job: ``parts`` are its options, then its inputs in their order."""
    connection.send(task)
    for part in parts:
        connection.send_bytes(part)


def take(connection: Connection) -> GivenTask:
    """Wait for a job.

    Raises
    ------
    EOFError
        If the worker has ended, or has no more use for the child.
    """
    task: ChildTask = connection.recv()
    options = connection.recv_bytes()
    inputs = {name: connection.recv_bytes() for name in task.inputs}
    return GivenTask(task=task, options=options, inputs=inputs)
