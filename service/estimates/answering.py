"""What an estimator process runs, by its dotted name, as with the pipeline of a worker."""

import importlib
from pathlib import Path
from typing import Protocol, cast

from api_schemas.initial_poses import InitialPose
from service.estimates.messages import BodyTask, ConversionTask, InitialPoseTask
from service.estimates.port import EstimatedBody


class Answers(Protocol):
    """A module with these four functions.

    ``body`` and ``initial_pose`` raise
    :class:`service.worker.pipeline_port.UnusableInputError` where the question is at fault.
    """

    def prepare(self, models: Path | None) -> None:
        """Load the body models, and whatever else takes long the first time."""
        ...

    def body(self, task: BodyTask, models: Path | None) -> EstimatedBody:
        """Estimate a body from measurements."""
        ...

    def initial_pose(self, task: InitialPoseTask, models: Path | None) -> InitialPose:
        """Pose the mean person by clicks."""
        ...

    def conversion(self, task: ConversionTask, glb: bytes) -> bytes:
        """Write the body of a GLB file in another format."""
        ...


def load_answers(module: str) -> Answers:
    """Import the module of that dotted name."""
    return cast("Answers", importlib.import_module(module))
