"""A pipeline that does what the picture tells it: the script is JSON behind a PNG header.

``gate`` keeps a job from ending until the file of this name exists; ``note_end`` names a file that
is there once its process has nothing more to do.
"""

import ctypes
import json
import os
import struct
import time
import zlib
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Final

from api_schemas.fit import FitRequest
from api_schemas.problems import FieldProblem
from api_schemas.products import ProductRequest
from api_schemas.service import BodyModelInfo, BodyModels
from fitter.vocabulary.choices import Gender
from service.compute.tasks import (
    OPTIONS,
    PRODUCT,
    ChildSetup,
    Observe,
    Parts,
    Task,
    UnusableInputError,
    with_result_document,
)
from service.jobs.inputs import PERSON, RESULT, SentPicture, pictures_of
from service.jobs.records import FIT, Report
from service.settings import Settings
from tests.integration.service.fake_products import made_product
from tests.integration.service.fake_results import fit_result, result_files

STAGES = ("observation", "initial_pose", "segmentation", "silhouette_and_edges", "measurement")
SCRIPT_MARK = b"#script:"

GATE_LOOK_S = 0.01

NOBODYS_WEIGHT_KG = 33.0
"""Contradicts whatever else is given, as the estimator says too."""

UNNOTICED_WEIGHT_KG = 34.0
"""As well, but the estimator has nothing against it."""


def scripted_image(
    script: dict[str, object] | None = None, *, width: int = 640, height: int = 480
) -> bytes:
    """A PNG up to where its pixels would begin, followed by what the pipeline is to do."""
    header = b"IHDR" + struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    chunks = b"".join(
        struct.pack(">I", len(each) - 4) + each + struct.pack(">I", zlib.crc32(each))
        for each in (header, b"IDAT")
    )
    return b"\x89PNG\r\n\x1a\n" + chunks + SCRIPT_MARK + json.dumps(script or {}).encode()


def fit(_setup: ChildSetup, parts: Parts, observe: Observe) -> Parts:
    """Do what each picture says, one after the other, and what the first says in the end."""
    asked, pictures = FitRequest.model_validate_json(parts[OPTIONS]), pictures_of(parts)
    scripts = [_script(each) for each in pictures]
    _begin(scripts[0])
    if len(scripts) == 1:
        _run_one(scripts[0], observe)
    else:
        for view, script in enumerate(scripts):
            observe(Report(stage=STAGES[0], progress=0.5 * view / len(scripts), view=view))
            _check(script, view)
            _go_on(script)
        observe(Report(stage="shading", progress=0.5))
    if asked.weight_kg in (NOBODYS_WEIGHT_KG, UNNOTICED_WEIGHT_KG):
        raise UnusableInputError(
            FieldProblem(
                field="weight_kg",
                code="contradictory-measurements",
                reason="Nobody has all of these together.",
                remedy="Leave out the least certain.",
            )
        )
    _go_on(scripts[0] | {"seconds": 0.0})
    return with_result_document(fit_result(asked), result_files([each.image for each in pictures]))


def _run_one(script: dict[str, Any], observe: Observe) -> None:
    for step, stage in enumerate(STAGES):
        observe(Report(stage=stage, progress=step / len(STAGES), energies={"total": 10.0 - step}))
        _work(script.get("seconds", 0.0) / len(STAGES), burn=script.get("burn", False))
    _check(script, 0)


def _check(script: dict[str, Any], view: int) -> None:
    if script.get("unusable"):
        raise UnusableInputError(
            FieldProblem(
                field=f"views.{view}.image",
                code="image-truncated",
                reason="The picture ends too early.",
                remedy="Send the whole file.",
            )
        )


def _script(picture: SentPicture[bytes]) -> dict[str, Any]:
    return json.loads(picture.image.partition(SCRIPT_MARK)[2])


def make(_setup: ChildSetup, parts: Parts, observe: Observe) -> Parts:
    """Do what the fit's picture said under ``product``; the person is that picture."""
    options = ProductRequest.model_validate_json(parts[OPTIONS]).root
    script = json.loads(parts[PERSON].partition(SCRIPT_MARK)[2]).get("product", {})
    _begin(script)
    observe(Report(stage=options.kind, progress=0.5))
    _go_on(script)
    result, files = made_product(options, parts)
    return {**files, RESULT: result.model_dump_json().encode()}


def _begin(script: dict[str, Any]) -> None:
    if "note_pid" in script:
        with Path(script["note_pid"]).open("a") as stream:
            stream.write(f"{os.getpid()}\n")


def _go_on(script: dict[str, Any]) -> None:
    _work(script.get("seconds", 0.0), burn=script.get("burn", False))
    while "gate" in script and not Path(script["gate"]).exists():
        time.sleep(GATE_LOOK_S)
    if script.get("fault"):
        message = "a fault in the fake"
        raise RuntimeError(message)
    if script.get("exhaust_memory"):
        raise MemoryError
    if script.get("segfault"):
        ctypes.string_at(0)
    if "note_end" in script:
        Path(script["note_end"]).touch()


def describe(_settings: Settings) -> BodyModels:
    return BodyModels(
        models=tuple(
            BodyModelInfo(
                gender=gender,
                mean_height_m=1.7,
                vertices=3,
                triangles=1,
                shape_coefficients=2,
                parts=("pelvis",),
                landmarks=("nose",),
                format_version=1,
                checksum="0" * 64,
                sources=("none",),
                licences=("none",),
            )
            for gender in Gender
        )
    )


def _work(seconds: float, *, burn: bool) -> None:
    end = time.monotonic() + seconds
    while (remaining := end - time.monotonic()) > 0.0:
        if not burn:
            time.sleep(remaining)


TASKS: Final[Mapping[str, Task]] = {FIT: fit, PRODUCT: make}
