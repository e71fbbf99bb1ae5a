"""What the API asks estimators: the tasks by name, and what each is given and gives.

Each is given a part with its question, JSON, and where there is one a file; each gives a part with
its answer, JSON, and where there is one a file.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from pydantic import BaseModel

from api_schemas.base import WireModel
from api_schemas.questions import (
    BodyEstimate,
    BodyRequest,
    InitialPose,
    InitialPoseRequest,
    PointsProposal,
    PointsRequest,
)
from service.compute.tasks import ChildSetup, Observe, Parts, Task

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


def estimate_tasks(
    *,
    body: Callable[[BodyTask, Path | None], EstimatedBody],
    initial_pose: Callable[[InitialPoseRequest, Path | None], InitialPose],
    points: Callable[..., ProposedPoints],
    conversion: Callable[[ConversionTask, bytes], bytes],
    jpeg: Callable[..., bytes],
) -> Mapping[str, Task]:
    """The table of what answers, as :mod:`service.estimates.answers` does."""

    def body_task(setup: ChildSetup, parts: Parts, _: Observe) -> Parts:
        found = body(BodyTask.model_validate_json(parts[QUESTION]), setup.models)
        return _answered(found.estimate, found.glb)

    def initial_pose_task(setup: ChildSetup, parts: Parts, _: Observe) -> Parts:
        asked = InitialPoseRequest.model_validate_json(parts[QUESTION])
        return _answered(initial_pose(asked, setup.models))

    def points_task(setup: ChildSetup, parts: Parts, _: Observe) -> Parts:
        found = points(
            PointsRequest.model_validate_json(parts[QUESTION]),
            parts[FILE],
            max_pixels=setup.max_pixels,
            detector=setup.detector,
        )
        return _answered(found.proposal, found.mask)

    def conversion_task(_setup: ChildSetup, parts: Parts, _: Observe) -> Parts:
        asked = ConversionTask.model_validate_json(parts[QUESTION])
        return {FILE: conversion(asked, parts[FILE])}

    def jpeg_task(setup: ChildSetup, parts: Parts, _: Observe) -> Parts:
        return {FILE: jpeg(parts[FILE], max_pixels=setup.max_pixels)}

    return {
        BODY: body_task,
        INITIAL_POSE: initial_pose_task,
        POINTS: points_task,
        CONVERSION: conversion_task,
        JPEG: jpeg_task,
    }


def _answered(answer: BaseModel, file: bytes = b"") -> Parts:
    return {ANSWER: answer.model_dump_json().encode(), FILE: file}
