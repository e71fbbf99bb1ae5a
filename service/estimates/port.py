"""What the API requires of an estimator, however it is implemented."""

from dataclasses import dataclass
from typing import Protocol

from api_schemas.bodies import BodyEstimate
from api_schemas.checks import CaptureCheck
from api_schemas.initial_poses import InitialPose
from api_schemas.proposals import PointsProposal
from service.estimates.messages import (
    BodyTask,
    CheckTask,
    ConversionTask,
    InitialPoseTask,
    PointsTask,
)


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


class NoDetectorError(Exception):
    """Nothing can be proposed or checked: the detector is not installed."""


class EstimatorUnavailableError(Exception):
    """No answer is available now: all processes are busy, starting, or cannot start."""


class EstimatorFailedError(Exception):
    """The question caused a fault or ended its process; others are not affected."""


class EstimatorTimeoutError(EstimatorFailedError):
    """The question took too long, and its process was replaced."""


class Estimator(Protocol):
    """Answers questions, in the order they come.

    Its methods raise :class:`service.submissions.refusal.RefusedError` where the question is at
    fault, and one of the errors above.
    """

    @property
    def capacity(self) -> int:
        """How many questions are accepted at a time, being answered or waiting; 0 if no process.

        One more is refused with :class:`EstimatorUnavailableError`.
        """
        ...

    def body(self, task: BodyTask, *, patient: bool = True) -> EstimatedBody:
        """Estimate a body from measurements.

        A caller that is not ``patient`` does not wait for a process that is still starting, and
        only briefly for a busy one.
        """
        ...

    def initial_pose(self, task: InitialPoseTask) -> InitialPose:
        """Pose the mean person to match clicks."""
        ...

    def points(self, task: PointsTask, image: bytes) -> ProposedPoints:
        """Propose the points of a person in an encoded picture.

        Raises
        ------
        NoDetectorError
            If there is no detector.
        """
        ...

    def check(self, task: CheckTask, image: bytes) -> CaptureCheck:
        """Say what is wrong with an encoded picture.

        Raises
        ------
        NoDetectorError
            If there is no detector, nor points to check without one.
        """
        ...

    def convert(self, task: ConversionTask, glb: bytes) -> bytes:
        """Write the body of one of the service's GLB files in another format."""
        ...

    def jpeg(self, image: bytes) -> bytes:
        """Write an encoded picture as a JPEG, upright."""
        ...
