"""What a child process tells its worker, as JSON over a pipe."""

from typing import Annotated, Final, Literal

from pydantic import Field, TypeAdapter

from api_schemas.base import WireModel
from api_schemas.body_models import BodyModels
from api_schemas.problems import Problem


class ProgressMessage(WireModel):
    """The job goes on."""

    kind: Literal["progress"] = "progress"
    stage: str
    progress: float
    energies: dict[str, float]


class FileMessage(WireModel):
    """A file of the result; its bytes follow as the next message."""

    kind: Literal["file"] = "file"
    name: str


class DoneMessage(WireModel):
    """The job is done; all its files were sent."""

    kind: Literal["done"] = "done"
    stage_seconds: dict[str, float]


class ProblemMessage(WireModel):
    """The job ended without a result."""

    kind: Literal["problem"] = "problem"
    problem: Problem


class DescriptionMessage(WireModel):
    """The body models there are."""

    kind: Literal["description"] = "description"
    body_models: BodyModels


class UnusableModelsMessage(WireModel):
    """The body models cannot be used."""

    kind: Literal["unusable-models"] = "unusable-models"
    reason: str


Message = Annotated[
    ProgressMessage
    | FileMessage
    | DoneMessage
    | ProblemMessage
    | DescriptionMessage
    | UnusableModelsMessage,
    Field(discriminator="kind"),
]
MESSAGES: Final[TypeAdapter[Message]] = TypeAdapter(Message)
