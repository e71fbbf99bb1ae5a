"""A pipeline that does what the picture tells it: the script is JSON behind a PNG header.

``gate`` keeps a job from ending until the file of this name exists; ``note_end`` names a file that
is there once its process has nothing more to do. Results and files are of some kinds, without
numbers.
"""

import ctypes
import json
import os
import struct
import time
import zlib
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, Final

from api_schemas.fit import FitRequest
from api_schemas.problems import FieldProblem
from api_schemas.products import AnyProductOptions, ProductRequest
from api_schemas.products.base import BodyColours, ProductResult
from api_schemas.products.bodies import (
    AnimationOptions,
    AnimationResult,
    CaricatureOptions,
    CaricatureResult,
    PoseOptions,
    PoseResult,
)
from api_schemas.products.documents import CompositionOptions, CompositionResult
from api_schemas.results import (
    BodyResult,
    CameraResult,
    FitResult,
    Measurement,
    Stage,
    ViewResult,
)
from api_schemas.service import BodyModelInfo, BodyModels
from fitter.vocabulary.choices import Gender, ViewKind
from fitter.vocabulary.outcomes import FocalLengthSource, Outcome, Verdict
from fitter.vocabulary.remarks import Note, assumed
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
from service.jobs.inputs import (
    BODY,
    CLIP,
    OVERLAY,
    PERSON,
    RESULT,
    SEGMENTATION,
    SentPicture,
    of_view,
    pictures_of,
)
from service.jobs.records import FIT, Report
from service.settings import Settings

BODY_RESULT = BodyResult(
    pose={"pelvis": (0.0, 0.0, 0.0)},
    translation_m=(0.0, 0.0, 3.0),
    shape=(0.0, 0.0),
)


def fit_result(asked: FitRequest) -> FitResult:
    waist = 80.0 + len(asked.views[0].points)
    return FitResult(
        gender=asked.gender,
        height_m=asked.height_m or 1.7,
        cues=asked.cues,
        optimizer=asked.optimizer,
        energies={"total": 1.0},
        evaluations=3,
        measurements=(
            Measurement(
                name="waist_girth",
                value=waist,
                unit="cm",
                standard_error=1.0,
                low=waist - 1.96,
                high=waist + 1.96,
                given=False,
                definition="At the navel.",
                source="ISO 8559-1",
            ),
        ),
        shape=(0.0, 0.0),
        verdict=Verdict.PLAUSIBLE,
        outcome_explanation="The energy stopped decreasing.",
        agreement=0.5 if len(asked.views) > 1 else None,
        assumptions=(assumed(Note.HEIGHT_ASSUMED, "Unknown.", where=("height_m",)),),
        warnings=(),
        differences=(),
        stages=(Stage(name="SE", energies={"total": 2.0}, measurements={"waist_girth": 81.0}),),
        stage_seconds={"observation": 0.1},
        files=(),
        views=tuple(_view(each.view) for each in asked.views),
    )


def result_files(images: Sequence[bytes]) -> dict[str, bytes]:
    files = {"body_canonical.glb": b"glTF" + bytes(range(256)), BODY: b"PNG", PERSON: images[0]}
    for number, image in enumerate(images):
        files[of_view(number, "body_posed.glb")] = b"glTF" + bytes([number])
        files[of_view(number, OVERLAY)] = image
        files[of_view(number, SEGMENTATION)] = b"PNG"
    return files


def _view(kind: ViewKind | None) -> ViewResult:
    camera = CameraResult(
        focal_length_px=700.0, centre_x=320.0, centre_y=240.0, width=640, height=480
    )
    return ViewResult(
        view=kind,
        outcome=Outcome.CONVERGED,
        verdict=Verdict.PLAUSIBLE,
        camera=camera,
        image_camera=camera,
        focal_length_source=FocalLengthSource.ASSUMED,
        body=BODY_RESULT,
        light=None,
        reflectance=None,
        silhouette_overlap=0.9,
        tilt=None,
        limb_facing=(),
        findings=(),
        clothing=(),
        assumptions=(assumed(Note.LENS_ASSUMED, "Unknown.", where=("focal_length_35mm",)),),
        warnings=(),
    )


LARGEST_FACTOR = 6.0
"""Of a caricature."""


def made_product(
    options: AnyProductOptions, parts: Parts
) -> tuple[ProductResult, dict[str, bytes]]:
    """What there is to say of the product, and its files."""
    match options:
        case CaricatureOptions(factor=factor) if factor > LARGEST_FACTOR:
            raise UnusableInputError(
                FieldProblem(
                    field="factor",
                    code="factor-unusable",
                    reason="The surface turns inside out.",
                    remedy=f"Send a factor from 0 to {LARGEST_FACTOR}.",
                    largest=LARGEST_FACTOR,
                )
            )
        case CaricatureOptions(factor=factor):
            result = CaricatureResult(
                factor=factor,
                coefficient=1,
                before=1.5,
                after=1.5 * factor,
                height_m=1.8,
                shape=(0.0, 1.5 * factor),
            )
            return result, {"body_caricature.glb": b"glTF"}
        case AnimationOptions():
            result = AnimationResult(
                source=parts.get(CLIP, b"a walk").decode()[:40],
                frames=2,
                frame_time_s=0.04,
                morph_targets=1,
                morph_mean_error_mm=0.0,
                morph_largest_error_mm=0.0,
                skin_mean_error_mm=0.0,
                skin_largest_error_mm=0.0,
                sliding_mm=0.0,
                travelled_m=0.0,
                warnings=(),
            )
            return result, {"body_animated.glb": b"glTF"}
        case PoseOptions():
            result = PoseResult(pose={}, colours=BodyColours.PLAIN)
            return result, {"body_reposed.glb": b"glTF" + bytes(range(256)), "pose.png": b"PNG"}
        case CompositionOptions():
            result = CompositionResult(bmi=22.0, estimates=())
            return result, {"composition.csv": b"name,percent\r\n"}
        case other:
            message = f"the fake makes no {other.kind}"
            raise NotImplementedError(message)


STAGES = ("observation", "initial_pose", "segmentation", "silhouette_and_edges", "measurement")
SCRIPT_MARK = b"#script:"

GATE_LOOK_S = 0.01


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
