"""What a child process tells its worker, as JSON over a pipe."""

from typing import Annotated, Final, Literal

from pydantic import Field, TypeAdapter

from api_schemas.base import WireModel
from api_schemas.problems import Problem


class ProgressMessage(WireModel):
    """The job has made progress."""

    kind: Literal["progress"] = "progress"
    stage: str
    progress: float
    energies: dict[str, float]
    view: int | None = None


class FileMessage(WireModel):
    """A file of the result; its bytes follow as the next message."""

    kind: Literal["file"] = "file"
    name: str


class DoneMessage(WireModel):
    """The job is done, and all its files have been sent."""

    kind: Literal["done"] = "done"
    stage_seconds: dict[str, float]


class ProblemMessage(WireModel):
    """The job ended without a result."""

    kind: Literal["problem"] = "problem"
    problem: Problem


Message = Annotated[
    ProgressMessage | FileMessage | DoneMessage | ProblemMessage, Field(discriminator="kind")
]
MESSAGES: Final[TypeAdapter[Message]] = TypeAdapter(Message)
