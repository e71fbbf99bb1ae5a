"""The tasks of estimators: from a question's bytes to those of its answer."""

from collections.abc import Callable, Mapping
from pathlib import Path

from pydantic import BaseModel

from api_schemas.checks import CaptureCheck, CheckRequest
from api_schemas.initial_poses import InitialPose
from api_schemas.proposals import PointsRequest
from service.estimates import questions
from service.estimates.questions import (
    ANSWER,
    FILE,
    QUESTION,
    BodyTask,
    ConversionTask,
    EstimatedBody,
    InitialPoseTask,
    ProposedPoints,
)
from service.numerics.tasks import ChildSetup, Observe, Parts, Task


def estimate_tasks(
    *,
    body: Callable[[BodyTask, Path | None], EstimatedBody],
    initial_pose: Callable[[InitialPoseTask, Path | None], InitialPose],
    points: Callable[..., ProposedPoints],
    check: Callable[..., CaptureCheck],
    conversion: Callable[[ConversionTask, bytes], bytes],
    jpeg: Callable[..., bytes],
) -> Mapping[str, Task]:
    """The table of what answers, as :mod:`service.estimates.answers` does."""

    def body_task(setup: ChildSetup, parts: Parts, _: Observe) -> Parts:
        found = body(BodyTask.model_validate_json(parts[QUESTION]), setup.models)
        return _answered(found.estimate, found.glb)

    def initial_pose_task(setup: ChildSetup, parts: Parts, _: Observe) -> Parts:
        asked = InitialPoseTask.model_validate_json(parts[QUESTION])
        return _answered(initial_pose(asked, setup.models))

    def points_task(setup: ChildSetup, parts: Parts, _: Observe) -> Parts:
        found = points(
            PointsRequest.model_validate_json(parts[QUESTION]),
            parts[FILE],
            max_pixels=setup.max_pixels,
            detector=setup.detector,
        )
        return _answered(found.proposal, found.mask)

    def check_task(setup: ChildSetup, parts: Parts, _: Observe) -> Parts:
        found = check(
            CheckRequest.model_validate_json(parts[QUESTION]),
            parts[FILE],
            max_pixels=setup.max_pixels,
            detector=setup.detector,
        )
        return _answered(found)

    def conversion_task(_setup: ChildSetup, parts: Parts, _: Observe) -> Parts:
        asked = ConversionTask.model_validate_json(parts[QUESTION])
        return {FILE: conversion(asked, parts[FILE])}

    def jpeg_task(setup: ChildSetup, parts: Parts, _: Observe) -> Parts:
        return {FILE: jpeg(parts[FILE], max_pixels=setup.max_pixels)}

    return {
        questions.BODY: body_task,
        questions.INITIAL_POSE: initial_pose_task,
        questions.POINTS: points_task,
        questions.CHECK: check_task,
        questions.CONVERSION: conversion_task,
        questions.JPEG: jpeg_task,
    }


def _answered(answer: BaseModel, file: bytes = b"") -> Parts:
    return {ANSWER: answer.model_dump_json().encode(), FILE: file}
