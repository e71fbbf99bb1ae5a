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
    PointsProposal,
    PointsRequest,
)
from api_schemas.results import Measurement
from service.compute.questions import (
    BODY,
    CONVERSION,
    FILE,
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
    for name in task.request.measurements:
        _obey(name)
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
            clothing=None,
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


def _obey(name: str) -> None:
    if name == "segfault":
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
    POINTS: points,
    CONVERSION: conversion,
    JPEG: jpeg,
}
