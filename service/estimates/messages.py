"""The messages between the API and its estimator, as JSON over a socket.

Questions and answers are two messages each: the JSON, and the bytes of a file, which may be empty.
"""

from typing import Annotated, Final, Literal

from pydantic import Field, TypeAdapter

from api_schemas.base import WireModel
from api_schemas.bodies import BodyEstimate, BodyRequest
from api_schemas.checks import CaptureCheck, CheckRequest
from api_schemas.initial_poses import InitialPose
from api_schemas.problems import FieldProblem
from api_schemas.proposals import PointsProposal, PointsRequest
from api_schemas.requests import SubjectOptions

READY: Final = b"ready"
"""The estimator's second message: its models are loaded. Its first is the number of its process."""


class BodyTask(WireModel):
    """Estimate a body; ``with_glb`` asks for its file as well."""

    kind: Literal["body"] = "body"
    request: BodyRequest
    with_glb: bool


class InitialPoseTask(WireModel):
    """Pose the mean person to match clicks, named pixels of a picture of this size."""

    kind: Literal["initial_pose"] = "initial_pose"
    subject: SubjectOptions
    width: int
    height: int
    exif_focal_length_35mm: float | None


class ConversionTask(WireModel):
    """Write the body of the attached GLB file in the format of this ending."""

    kind: Literal["conversion"] = "conversion"
    ending: str


class PointsTask(WireModel):
    """Propose the points of a person in the attached picture."""

    kind: Literal["points"] = "points"
    request: PointsRequest


class CheckTask(WireModel):
    """Say what is wrong with the attached picture; points are named."""

    kind: Literal["check"] = "check"
    request: CheckRequest


class JpegTask(WireModel):
    """Write the attached picture as a JPEG, upright."""

    kind: Literal["jpeg"] = "jpeg"


class BodyAnswer(WireModel):
    """The estimated body."""

    kind: Literal["body"] = "body"
    estimate: BodyEstimate


class InitialPoseAnswer(WireModel):
    """The initial pose."""

    kind: Literal["initial_pose"] = "initial_pose"
    pose: InitialPose


class ConversionAnswer(WireModel):
    """The attached file is the requested one."""

    kind: Literal["conversion"] = "conversion"


class PointsAnswer(WireModel):
    """The proposal; the attached file is the person's mask, if it was requested."""

    kind: Literal["points"] = "points"
    proposal: PointsProposal


class CheckAnswer(WireModel):
    """What is wrong with the picture."""

    kind: Literal["check"] = "check"
    check: CaptureCheck


class JpegAnswer(WireModel):
    """The attached file is the picture."""

    kind: Literal["jpeg"] = "jpeg"


class NoDetectorAnswer(WireModel):
    """The estimator has no detector."""

    kind: Literal["no_detector"] = "no_detector"


class RefusalAnswer(WireModel):
    """The question is at fault."""

    kind: Literal["refusal"] = "refusal"
    error: FieldProblem


class FaultAnswer(WireModel):
    """The estimator is at fault; its log says how."""

    kind: Literal["fault"] = "fault"


Task = Annotated[
    BodyTask | InitialPoseTask | ConversionTask | PointsTask | CheckTask | JpegTask,
    Field(discriminator="kind"),
]
Answer = Annotated[
    BodyAnswer
    | InitialPoseAnswer
    | ConversionAnswer
    | PointsAnswer
    | CheckAnswer
    | JpegAnswer
    | NoDetectorAnswer
    | RefusalAnswer
    | FaultAnswer,
    Field(discriminator="kind"),
]
TASKS: Final[TypeAdapter[Task]] = TypeAdapter(Task)
ANSWERS: Final[TypeAdapter[Answer]] = TypeAdapter(Answer)
