"""Answers that do what the question tells them: the script is in a measurement's name.

``gate`` holds the answer back until the file named by the environment variable of ``GATE`` exists.
"""

import ctypes
import json
import os
import time
from pathlib import Path

from api_schemas.points import Point, PointSource
from api_schemas.problems import FieldProblem
from api_schemas.questions import (
    BodyEstimate,
    ImageSize,
    InitialPose,
    InitialPoseRequest,
    PointsProposal,
    PointsRequest,
)
from api_schemas.results import BodyResult, CameraResult, Measurement
from fitter.vocabulary.choices import Facing
from fitter.vocabulary.outcomes import (
    FacingSource,
    FocalLengthSource,
    LimbFacing,
)
from service.compute.questions import (
    BODY,
    CONVERSION,
    FILE,
    INITIAL_POSE,
    JPEG,
    POINTS,
    QUESTION,
    BodyTask,
    ConversionTask,
    answered,
)
from service.compute.tasks import ChildSetup, Observe, Parts, UnusableInputError
from tests.integration.service.fake_pipeline import SCRIPT_MARK

GLB = b"glTF" + bytes(range(256))
# Processes that compute are left variables of Python's.
GATE = "PYTHON_FAKE_ANSWERS_GATE"
KNOWN_NAMES = ("waist_girth_navel", "hip_girth", "inseam")


def body(_setup: ChildSetup, parts: Parts, _: Observe) -> Parts:
    task = BodyTask.model_validate_json(parts[QUESTION])
    for name, value in task.request.measurements.items():
        _obey(name, value)
    return answered(
        BodyEstimate(
            gender=task.request.gender,
            height_m=task.request.height_m or 1.7,
            shape=(0.0, 0.0),
            measurements=(
                Measurement(
                    name="waist_girth_navel",
                    value=80.0,
                    unit="cm",
                    standard_error=float(os.getpid()),
                    low=70.0,
                    high=90.0,
                    given=False,
                    definition="At the navel.",
                    source="ISO 8559-1",
                ),
            ),
            plausibility=1.0,
            body_model="0" * 64,
        ),
        GLB if task.with_glb else b"",
    )


def initial_pose(_setup: ChildSetup, parts: Parts, _: Observe) -> Parts:
    asked = InitialPoseRequest.model_validate_json(parts[QUESTION])
    size = asked.image_size
    return answered(
        InitialPose(
            gender=asked.gender,
            height_m=asked.height_m or 1.7,
            camera=CameraResult(
                focal_length_px=700.0,
                centre_x=size.width / 2,
                centre_y=size.height / 2,
                width=size.width,
                height=size.height,
            ),
            focal_length_source=FocalLengthSource.ASSUMED,
            body=BodyResult(
                pose={"pelvis": (0.0, 0.0, 0.0)},
                translation_m=(0.0, 0.0, 3.0),
                shape=(0.0, 0.0),
            ),
            outline=(((1.0, 1.0), (2.0, 1.0), (2.0, 2.0)),),
            points={"nose": (1.0, 1.0)},
            residual_px=dict.fromkeys(asked.points, 0.5),
            limbs=(
                LimbFacing(
                    limb="left_shin",
                    facing=Facing.TOWARD,
                    source=FacingSource.PRIOR,
                    ambiguous=True,
                    alternative_nats=1.0,
                ),
            ),
            assumptions=(),
            warnings=(),
        )
    )


def points(_setup: ChildSetup, parts: Parts, _: Observe) -> Parts:
    """See as many people as the picture says, of one of them a nose."""
    asked, image = PointsRequest.model_validate_json(parts[QUESTION]), parts[FILE]
    script = json.loads(image.partition(SCRIPT_MARK)[2])
    if script.get("segfault"):
        ctypes.string_at(0)
    nose = Point(x=10.0, y=20.0, visibility=2, source=PointSource.PROPOSAL, confidence=0.9)
    return answered(
        PointsProposal(
            image_size=ImageSize(width=640, height=480),
            persons=((0.0, 0.0, 64.0, 48.0),) * script.get("people", 1),
            person=asked.person or 0,
            points={"nose": nose},
            doubtful=(),
            usable=True,
            findings=(),
            not_checked=(),
            seen_from=None,
            lean_deg=None,
            distance_m=None,
            assumptions=(),
            warnings=(),
        )
    )


def conversion(_setup: ChildSetup, parts: Parts, _: Observe) -> Parts:
    task = ConversionTask.model_validate_json(parts[QUESTION])
    return {FILE: f"{task.ending} of {len(parts[FILE])} bytes".encode()}


def jpeg(setup: ChildSetup, parts: Parts, _: Observe) -> Parts:
    told = f"JPEG of {len(parts[FILE])} bytes, at most {setup.max_pixels} pixels"
    return {FILE: told.encode()}


def _obey(name: str, value: object) -> None:
    if name == "sleep":
        time.sleep(float(str(value)))
    elif name == "segfault":
        ctypes.string_at(0)
    elif name == "fault":
        message = "a fault in the fake"
        raise RuntimeError(message)
    elif name == "gate":
        while not Path(os.environ[GATE]).exists():
            time.sleep(0.01)
    elif name not in KNOWN_NAMES:
        raise UnusableInputError(
            FieldProblem(
                field=f"measurements.{name}",
                code="unknown-value",
                reason="There is no measurement of this name.",
                remedy="Use waist_girth_navel.",
            )
        )


TASKS = {
    BODY: body,
    INITIAL_POSE: initial_pose,
    POINTS: points,
    CONVERSION: conversion,
    JPEG: jpeg,
}
