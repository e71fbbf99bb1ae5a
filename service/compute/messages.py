"""Messages between processes that compute and those that have something computed.

A message is a header, JSON, and after it the parts that it names: bytes, each sent on its own. The
one who asks sends a task. The answer is any number of reports of progress and then one of the
others. Nothing is unpickled, whoever it came from.
"""

from collections.abc import Iterable
from dataclasses import dataclass
from multiprocessing.connection import Connection
from typing import Annotated, Final, Literal

from pydantic import Field, TypeAdapter

from api_schemas.base import WireModel
from api_schemas.problems import Problem
from service.compute.tasks import Parts
from service.jobs.records import Report

LARGEST_PART_BYTES: Final = 256 * 1024 * 1024
"""A child that sends more has been taken over by its picture."""


class _Header(WireModel):
    """``parts`` are the names of the parts that follow."""

    parts: tuple[str, ...] = ()


class TaskMessage(_Header):
    """Compute this, of the table of tasks; every line logged meanwhile has ``log_context``.

    Owners take turns where several ask the same processes.
    """

    kind: Literal["task"] = "task"
    task: str
    owner: str = ""
    log_context: dict[str, str] = Field(default_factory=dict[str, str])


class ProgressMessage(_Header):
    """The task has made progress."""

    kind: Literal["progress"] = "progress"
    report: Report


class DoneMessage(_Header):
    """The task is done; the parts are what it gave."""

    kind: Literal["done"] = "done"


class ProblemMessage(_Header):
    """The task ended without a result, for a reason that can be told."""

    kind: Literal["problem"] = "problem"
    problem: Problem


class FaultMessage(_Header):
    """The task met a fault, which its process has logged, or the limit of its memory."""

    kind: Literal["fault"] = "fault"
    out_of_memory: bool = False


Message = Annotated[
    TaskMessage | ProgressMessage | DoneMessage | ProblemMessage | FaultMessage,
    Field(discriminator="kind"),
]
MESSAGES: Final[TypeAdapter[Message]] = TypeAdapter(Message)


@dataclass(frozen=True, slots=True)
class Received:
    """A message and its parts."""

    message: Message
    parts: Parts


def send(connection: Connection, message: Message, parts: Iterable[bytes] = ()) -> None:
    """Send a message, and its parts in their order, each as soon as it is there."""
    connection.send_bytes(MESSAGES.dump_json(message))
    for part in parts:
        connection.send_bytes(part)


def receive(connection: Connection) -> Received:
    """Wait for a message and its parts.

    Raises
    ------
    EOFError, OSError
        If the other side has ended, or sends what is too large.
    ValidationError
        If what comes is no message.
    """
    message = MESSAGES.validate_json(connection.recv_bytes(LARGEST_PART_BYTES))
    return Received(
        message, {name: connection.recv_bytes(LARGEST_PART_BYTES) for name in message.parts}
    )
