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
    SeenFrom,
)
from fitter.vocabulary.remarks import Code, Severity, remark
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
from service.compute.tasks import ChildSetup, Observe, Parts, ProblemError, UnusableInputError
from service.submissions.submission import no_detector
from tests.integration.service.fake_pipeline import NOBODYS_WEIGHT_KG, SCRIPT_MARK

GLB = b"glTF" + bytes(range(256))
MASK = b"\x89PNG" + bytes(range(64))
# Processes that compute are left variables of Python's.
GATE = "PYTHON_FAKE_ANSWERS_GATE"
NOBODY = remark(Code.NOBODY_FOUND, "0 people were found.", severity=Severity.BLOCKS)
KNOWN_NAMES = ("waist_girth_navel", "hip_girth", "inseam")


def body(_setup: ChildSetup, parts: Parts, _: Observe) -> Parts:
    task = BodyTask.model_validate_json(parts[QUESTION])
    for name, value in task.request.measurements.items():
        _obey(name, value)
    if task.request.weight_kg == NOBODYS_WEIGHT_KG:
        raise UnusableInputError(
            FieldProblem(
                field="weight_kg",
                code="contradictory-measurements",
                reason="Nobody has all of these together.",
                remedy="Leave out the least certain.",
            )
        )
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
    """See as many people as the picture says, of one of them a nose, and repeat what was asked."""
    asked, image = PointsRequest.model_validate_json(parts[QUESTION]), parts[FILE]
    script = json.loads(image.partition(SCRIPT_MARK)[2])
    if script.get("no_detector") and not asked.points:
        raise ProblemError(no_detector())
    if script.get("segfault"):
        ctypes.string_at(0)
    count = script.get("people", 1)
    person = asked.person or 0
    if person >= max(count, 1):
        raise UnusableInputError(
            FieldProblem(
                field="person",
                code="person-unknown",
                reason="There is no such person.",
                remedy="Leave it out.",
            )
        )
    nose = Point(
        x=10.0 + person,
        y=20.0,
        visibility=2,
        source=PointSource.PROPOSAL,
        confidence=0.9,
    )
    return answered(
        PointsProposal(
            image_size=ImageSize(width=640, height=480),
            persons=((0.0, 0.0, 64.0, 48.0),) * count,
            person=person if count else None,
            points={"nose": nose} if count else {},
            doubtful=(),
            usable=count > 0,
            findings=() if count else (NOBODY,),
            not_checked=(),
            seen_from=None if asked.view is None else SeenFrom(asked.view.value),
            lean_deg=float(len(asked.points)),
            distance_m=asked.focal_length_px,
            assumptions=(),
            warnings=(),
        ),
        MASK if asked.mask and count else b"",
    )


def conversion(_setup: ChildSetup, parts: Parts, _: Observe) -> Parts:
    task = ConversionTask.model_validate_json(parts[QUESTION])
    return {FILE: f"{task.ending} of {len(parts[FILE])} bytes".encode()}


def jpeg(setup: ChildSetup, parts: Parts, _: Observe) -> Parts:
    image = parts[FILE]
    script = json.loads(image.partition(SCRIPT_MARK)[2])
    if script.get("damaged"):
        raise UnusableInputError(
            FieldProblem(
                field="image",
                code="image-damaged",
                reason="The file is truncated or damaged.",
                remedy="Send the whole file.",
            )
        )
    told = f"JPEG of {len(image)} bytes, at most {setup.max_pixels} pixels"
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
