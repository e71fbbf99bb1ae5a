"""What an estimator process runs, by its dotted name, as with the pipeline of a worker."""

import importlib
from pathlib import Path
from typing import Protocol, cast

from api_schemas.checks import CaptureCheck
from api_schemas.initial_poses import InitialPose
from service.estimates.messages import (
    BodyTask,
    CheckTask,
    ConversionTask,
    InitialPoseTask,
    PointsTask,
)
from service.estimates.port import EstimatedBody, ProposedPoints


class Answers(Protocol):
    """A module with these seven functions.

    ``body``, ``initial_pose``, ``points``, ``check`` and ``jpeg`` raise
    :class:`service.worker.pipeline_port.UnusableInputError` if the question is at fault.
    ``models`` and ``detector`` are folders, None for what is installed.
    """

    def prepare(self, models: Path | None, detector: Path | None) -> None:
        """Load body models and detector, and whatever else takes long the first time."""
        ...

    def body(self, task: BodyTask, models: Path | None) -> EstimatedBody:
        """Estimate a body from measurements."""
        ...

    def initial_pose(self, task: InitialPoseTask, models: Path | None) -> InitialPose:
        """Pose the mean person to match clicks."""
        ...

    def points(
        self, task: PointsTask, image: bytes, *, max_pixels: int, detector: Path | None
    ) -> ProposedPoints:
        """Propose the points of a person in an encoded picture.

        Raises
        ------
        NoDetectorError
            If there is no detector.
        """
        ...

    def check(
        self, task: CheckTask, image: bytes, *, max_pixels: int, detector: Path | None
    ) -> CaptureCheck:
        """Say what is wrong with an encoded picture.

        Raises
        ------
        NoDetectorError
            If there is no detector, nor points to check without one.
        """
        ...

    def conversion(self, task: ConversionTask, glb: bytes) -> bytes:
        """Write the body of a GLB file in another format."""
        ...

    def jpeg(self, image: bytes, *, max_pixels: int) -> bytes:
        """Write an encoded picture as a JPEG, upright."""
        ...


def load_answers(module: str) -> Answers:
    """Import the module of that dotted name."""
    return cast("Answers", importlib.import_module(module))
