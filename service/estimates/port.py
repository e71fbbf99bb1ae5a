"""What the API asks of an estimator, whatever stands behind it."""

from dataclasses import dataclass
from typing import Protocol

from api_schemas.bodies import BodyEstimate
from api_schemas.initial_poses import InitialPose
from service.estimates.messages import BodyTask, InitialPoseTask


@dataclass(frozen=True, slots=True, kw_only=True)
class EstimatedBody:
    """The answer, and the GLB file where the task asks for it, else nothing."""

    estimate: BodyEstimate
    glb: bytes


class EstimatorUnavailableError(Exception):
    """No answer can be had now: all are busy, starting, or cannot start."""


class EstimatorFailedError(Exception):
    """The question ended its process or took too long; others are not affected."""


class Estimator(Protocol):
    """Answers questions, in the order they come.

    Both methods raise :class:`service.refusal.RefusedError` where the question is at fault, and
    one of the errors above.
    """

    def body(self, task: BodyTask) -> EstimatedBody:
        """Estimate a body from measurements."""
        ...

    def initial_pose(self, task: InitialPoseTask) -> InitialPose:
        """Pose the mean person by clicks."""
        ...
