"""What the API asks estimators: the names of the tasks, and what each is given and gives.

Each is given a part with its question, JSON, and where there is one a file; each gives a part with
its answer, JSON, and where there is one a file.
"""

from dataclasses import dataclass
from typing import Final

from api_schemas.base import WireModel
from api_schemas.bodies import BodyEstimate, BodyRequest
from api_schemas.proposals import PointsProposal
from api_schemas.requests import SubjectOptions

BODY: Final = "body"
INITIAL_POSE: Final = "initial_pose"
POINTS: Final = "points"
CHECK: Final = "check"
CONVERSION: Final = "conversion"
JPEG: Final = "jpeg"

QUESTION: Final = "question"
ANSWER: Final = "answer"
FILE: Final = "file"


class BodyTask(WireModel):
    """Estimate a body; ``with_glb`` asks for its file as well."""

    request: BodyRequest
    with_glb: bool


class InitialPoseTask(WireModel):
    """Pose the mean person to match clicks, named pixels of a picture of this size."""

    subject: SubjectOptions
    width: int
    height: int
    exif_focal_length_35mm: float | None


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
