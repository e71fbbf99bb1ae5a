"""Questions of the API that are answered within a request: names of tasks, what they take and give.

Points, bodies of clicks and of measurements, and files in other formats take tenths of a second, so
they are not jobs. Each task is given a part with its question, JSON, and where there is one a file;
each gives a part with its answer, JSON, and where there is one a file.
"""

from dataclasses import dataclass
from typing import Final

from pydantic import BaseModel

from api_schemas.base import WireModel
from api_schemas.questions import (
    BodyEstimate,
    BodyRequest,
    PointsProposal,
)
from service.compute.tasks import Parts

BODY: Final = "body"
INITIAL_POSE: Final = "initial_pose"
POINTS: Final = "points"
CONVERSION: Final = "conversion"
JPEG: Final = "jpeg"

QUESTION: Final = "question"
ANSWER: Final = "answer"
FILE: Final = "file"


class BodyTask(WireModel):
    """Estimate a body; ``with_glb`` asks for its file as well."""

    request: BodyRequest
    with_glb: bool


class ConversionTask(WireModel):
    """Write the body of the GLB file in the format of this ending."""

    ending: str


@dataclass(frozen=True, slots=True, kw_only=True)
class EstimatedBody:
    """The answer, and the GLB file if the task asks for it, else no bytes."""

    estimate: BodyEstimate
    glb: bytes


@dataclass(frozen=True, slots=True, kw_only=True)
class ProposedPoints:
    """The answer, and the mask's PNG file if the task asks for it, else no bytes."""

    proposal: PointsProposal
    mask: bytes


def answered(answer: BaseModel, file: bytes = b"") -> Parts:
    """The parts of an answer, and of its file where there is one."""
    return {ANSWER: answer.model_dump_json().encode(), FILE: file}
