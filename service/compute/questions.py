"""Questions of the API that are answered within a request: names of tasks, what they take and give.

Points, bodies of clicks and of measurements, and files in other formats take tenths of a second, so
they are not jobs. Each task is given a part with its question, JSON, and where there is one a file;
each gives a part with its answer, JSON, and where there is one a file.
"""

from typing import Final

from pydantic import BaseModel

from api_schemas.base import WireModel
from api_schemas.questions import BodyRequest
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


def answered(answer: BaseModel, file: bytes = b"") -> Parts:
    """The parts of an answer, and of its file where there is one."""
    return {ANSWER: answer.model_dump_json().encode(), FILE: file}
