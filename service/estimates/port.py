"""What the API asks of an estimator, whatever stands behind it."""

from dataclasses import dataclass
from typing import Protocol

from api_schemas.bodies import BodyEstimate
from api_schemas.initial_poses import InitialPose
from api_schemas.proposals import PointsProposal
from service.estimates.messages import BodyTask, ConversionTask, InitialPoseTask, PointsTask


@dataclass(frozen=True, slots=True, kw_only=True)
class EstimatedBody:
    """The answer, and the GLB file where the task asks for it, else nothing."""

    estimate: BodyEstimate
    glb: bytes


@dataclass(frozen=True, slots=True, kw_only=True)
class ProposedPoints:
    """The answer, and the mask's PNG file where the task asks for it, else nothing."""

    proposal: PointsProposal
    mask: bytes


class NoDetectorError(Exception):
    """Points cannot be proposed: the detector is not installed."""


class EstimatorUnavailableError(Exception):
    """No answer can be had now: all are busy, starting, or cannot start."""


class EstimatorFailedError(Exception):
    """The question met a fault or ended its process; others are not affected."""


class EstimatorTimeoutError(EstimatorFailedError):
    """The question took too long, and its process was replaced."""


class Estimator(Protocol):
    """Answers questions, in the order they come.

    Its methods raise :class:`service.submissions.refusal.RefusedError` where the question is at
    fault, and one of the errors above.
    """

    @property
    def capacity(self) -> int:
        """How many questions are taken at once, answered and waiting; none if there is no process.

        One more is refused with :class:`EstimatorUnavailableError`.
        """
        ...

    def body(self, task: BodyTask, *, patient: bool = True) -> EstimatedBody:
        """Estimate a body from measurements.

        Who is not ``patient`` waits neither for a process that is still starting nor, for more than
        a moment, for a busy one.
        """
        ...

    def initial_pose(self, task: InitialPoseTask) -> InitialPose:
        """Pose the mean person by clicks."""
        ...

    def points(self, task: PointsTask, image: bytes) -> ProposedPoints:
        """Propose the points of a person in an encoded picture.

        Raises
        ------
        NoDetectorError
            If there is no detector.
        """
        ...

    def convert(self, task: ConversionTask, glb: bytes) -> bytes:
        """Write the body of one of the service's GLB files in another format."""
        ...
