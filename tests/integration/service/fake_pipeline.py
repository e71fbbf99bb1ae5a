"""A pipeline that does what the picture tells it: the script is JSON behind a PNG header.

``gate`` keeps a job from ending until the file of this name exists.
"""

import ctypes
import json
import os
import struct
import time
import zlib
from collections.abc import Callable
from pathlib import Path
from typing import Any

from pydantic import TypeAdapter

from api_schemas.body_models import BodyModelInfo, BodyModels
from api_schemas.derivation_kinds import AnyDerivationOptions
from api_schemas.derivation_kinds.animation import AnimationOptions, AnimationResult
from api_schemas.derivation_kinds.base import DerivedFiles
from api_schemas.derivation_kinds.caricature import CaricatureOptions, CaricatureResult
from api_schemas.derivation_kinds.combined import CombinedOptions, CombinedPicture, CombinedResult
from api_schemas.derivation_kinds.texture import TextureColours, TextureOptions, TextureResult
from api_schemas.derivations import DerivationResult
from api_schemas.known import UncertainMeasurement
from api_schemas.problems import FieldProblem
from api_schemas.requests import FitOptions, Gender
from api_schemas.results import (
    Assumption,
    BodyResult,
    FitResult,
    FittedCameraResult,
    FocalLengthSource,
    Measurement,
    Outcome,
    PartRotation,
)
from api_schemas.scans import ScannedView, ScanResult
from service.api.derivation_kinds import KINDS
from service.engine.port import Report
from service.jobs.inputs import (
    BODY_POSED,
    CLIP,
    IMAGE,
    OVERLAY,
    PERSON,
    REQUEST,
    RESULT,
    SEGMENTATION,
    TEXTURE,
    file_of,
)
from service.worker.pipeline_port import (
    DerivationInput,
    DerivationOutput,
    PipelineInput,
    PipelineOutput,
    ScanInput,
    ScanOutput,
    UnusableInputError,
)

RESULTS: TypeAdapter[FitResult | ScanResult] = TypeAdapter(FitResult | ScanResult)
"""What derivations may be made of."""

STAGES = ("observation", "initial_pose", "segmentation", "silhouette_and_edges", "measurement")
SCRIPT_MARK = b"#script:"

GATE_LOOK_S = 0.01

NOBODYS_WEIGHT_KG = 33.0
"""Contradicts whatever else is given, as the estimator says too."""

LARGEST_FACTOR = 6.0
"""Of a caricature."""

FILES = {
    ".csv": b"label,probability\r\n",
    ".glb": b"glTF",
    ".html": b"<!doctype html><p>A report.",
    ".pdf": b"%PDF-1.4",
    ".png": b"PNG",
}

UNNOTICED_WEIGHT_KG = 34.0
"""As well, but the estimator has nothing against it."""


def scripted_image(
    script: dict[str, object] | None = None, *, width: int = 640, height: int = 480
) -> bytes:
    """A PNG as far as its header goes, followed by what the pipeline is to do."""
    header = b"IHDR" + struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    chunk = struct.pack(">I", 13) + header + struct.pack(">I", zlib.crc32(header))
    return b"\x89PNG\r\n\x1a\n" + chunk + SCRIPT_MARK + json.dumps(script or {}).encode()


def run(job: PipelineInput, observe: Callable[[Report], None]) -> PipelineOutput:
    script = json.loads(job.image.partition(SCRIPT_MARK)[2])
    _begin(script)
    for step, stage in enumerate(STAGES):
        observe(Report(stage=stage, progress=step / len(STAGES), energies={"total": 10.0 - step}))
        _work(script.get("seconds", 0.0) / len(STAGES), burn=script.get("burn", False))
    if script.get("unusable"):
        raise UnusableInputError(
            FieldProblem(
                field="image",
                code="image-truncated",
                reason="The picture ends too early.",
                remedy="Send the whole file.",
            )
        )
    if job.options.weight_kg in (NOBODYS_WEIGHT_KG, UNNOTICED_WEIGHT_KG):
        raise UnusableInputError(
            FieldProblem(
                field="weight_kg",
                code="contradictory-measurements",
                reason="Nobody has all of these together.",
                remedy="Leave out the least certain.",
            )
        )
    _go_on(script | {"seconds": 0.0})
    return PipelineOutput(
        result=_result(job),
        artifacts={
            "body_posed.glb": b"glTF" + bytes(range(256)),
            "overlay.png": job.image,
        }
        | ({} if script.get("old") else {"person.npz": job.image}),
    )


def scan(job: ScanInput, observe: Callable[[Report], None]) -> ScanOutput:
    """Do what each picture says, one after the other, and what the first says in the end."""
    scripts = [json.loads(each.image.partition(SCRIPT_MARK)[2]) for each in job.pictures]
    _begin(scripts[0])
    for view, script in enumerate(scripts):
        observe(Report(stage=STAGES[0], progress=0.5 * view / len(scripts), view=view))
        if script.get("unusable"):
            raise UnusableInputError(
                FieldProblem(
                    field=f"views.{view}.image",
                    code="image-truncated",
                    reason="The picture ends too early.",
                    remedy="Send the whole file.",
                )
            )
        _go_on(script)
    observe(Report(stage="shading", progress=0.5))
    fits = [
        _result(
            PipelineInput(
                options=job.options.of_view(view),
                image=each.image,
                mask=each.mask,
                max_pixels=job.max_pixels,
            )
        )
        for view, each in enumerate(job.pictures)
    ]
    first = fits[0]
    result = ScanResult(
        gender=first.gender,
        height_m=first.height_m,
        cues=first.cues,
        verdict=first.verdict,
        outcome_explanation=first.outcome_explanation,
        shape=first.body.shape,
        views=tuple(
            ScannedView(
                number=number,
                view=job.options.views[number].view,
                findings=(),
                **{name: getattr(fit, name) for name in _OF_A_VIEW},
            )
            for number, fit in enumerate(fits)
        ),
        measurements=first.measurements,
        agreement=0.5,
        assumptions=(),
        warnings=(),
        artifacts=(),
    )
    files = {"body_canonical.glb": b"glTF", "scan.png": b"PNG", PERSON: job.pictures[0].image}
    for number, each in enumerate(job.pictures):
        files[file_of(BODY_POSED, number)] = b"glTF" + bytes([number])
        files[file_of(OVERLAY, number)] = each.image
        files[file_of(SEGMENTATION, number)] = b"PNG"
    return ScanOutput(result=result, artifacts=files)


_OF_A_VIEW = tuple(set(ScannedView.model_fields) & set(FitResult.model_fields))


def derive(
    job: DerivationInput[AnyDerivationOptions], observe: Callable[[Report], None]
) -> DerivationOutput[DerivedFiles]:
    """Do what the fit's picture said under ``derivation``; the person is that picture."""
    script = json.loads(job.inputs[PERSON].partition(SCRIPT_MARK)[2]).get("derivation", {})
    _begin(script)
    observe(Report(stage=job.options.kind, progress=0.5))
    _go_on(script)
    return _derived(job)


def _derived(job: DerivationInput[AnyDerivationOptions]) -> DerivationOutput[DerivedFiles]:
    options = job.options
    if isinstance(options, CaricatureOptions):
        if options.factor > LARGEST_FACTOR:
            raise UnusableInputError(
                FieldProblem(
                    field="factor",
                    code="factor-unusable",
                    reason="The surface turns inside out.",
                    remedy=f"Send a factor from 0 to {LARGEST_FACTOR}.",
                )
            )
        result = CaricatureResult(
            factor=options.factor,
            coefficient=1,
            before=1.5,
            after=1.5 * options.factor,
            height_m=1.8,
            shape=(0.0, 1.5 * options.factor),
            artifacts=(),
        )
        files = {"body_caricature.glb": b"glTF", "caricature.png": b"PNG"}
    elif isinstance(options, CombinedOptions):
        fit = FitResult.model_validate_json(job.inputs[RESULT])
        assert job.fit_id is not None
        FitOptions.model_validate_json(job.inputs[REQUEST])
        assert len(job.others) == len(options.fits)
        for other in job.others:
            assert other[IMAGE] == other[PERSON]
            FitOptions.model_validate_json(other[REQUEST])
        result = CombinedResult(
            pictures=1 + len(options.fits),
            shape=(0.0, 0.5),
            bodies=tuple(
                CombinedPicture(
                    number=number,
                    fit_id=fit_id,
                    outcome=fit.outcome,
                    image_camera=fit.image_camera,
                    body=fit.body,
                    light=None,
                    reflectance=None,
                    silhouette_overlap=0.9,
                )
                for number, fit_id in enumerate((job.fit_id, *options.fits), start=1)
            ),
            measurements=fit.measurements,
            agreement=0.5,
            warnings=(),
            artifacts=(),
        )
        files = {"body_combined.glb": b"glTF", "combined.png": b"PNG"}
    elif isinstance(options, TextureOptions):
        # Who brings the colours has no copy of the picture.
        own = options.colours is TextureColours.OWN
        assert own is (TEXTURE in job.inputs) is (IMAGE not in job.inputs)
        result = TextureResult(
            colours=options.colours,
            size=len(job.inputs[TEXTURE]) if own else options.size,
            seen_share=0.4,
            mirrored_share=0.1,
            scale=1.0,
            artifacts=(),
        )
        files = {"body_textured.glb": b"glTF", "texture.png": b"PNG", "coverage.png": b"PNG"}
    elif isinstance(options, AnimationOptions):
        result = AnimationResult(
            source=job.inputs.get(CLIP, b"a walk").decode()[:40],
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
            artifacts=(),
        )
        files = {"body_animated.glb": b"glTF", "animation.webp": b"RIFF"}
    else:
        # Of any other kind what the OpenAPI document shows of it.
        if RESULT in job.inputs:
            RESULTS.validate_json(job.inputs[RESULT])
        shown = json.dumps(KINDS[options.kind].answer)
        result = DerivationResult.model_validate_json(shown).root
        files = {each.name: FILES[Path(each.name).suffix] for each in result.artifacts}
    return DerivationOutput(result=result, artifacts=files)


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


def describe(models: Path | None) -> BodyModels:
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


def _result(job: PipelineInput) -> FitResult:
    camera = FittedCameraResult(
        focal_length_px=700.0, centre_x=320.0, centre_y=240.0, width=640, height=480
    )
    return FitResult(
        gender=job.options.gender,
        height_m=job.options.height_m or 1.7,
        cues=job.options.cues,
        optimizer=job.options.optimizer,
        outcome=Outcome.CONVERGED,
        outcome_explanation="The energy stopped decreasing.",
        camera=camera,
        image_camera=camera,
        focal_length_source=FocalLengthSource.ASSUMED,
        body=BodyResult(
            pose=(PartRotation(part="pelvis", rotation=(0.0, 0.0, 0.0)),),
            translation_m=(0.0, 0.0, 3.0),
            shape=(0.0, 0.0),
        ),
        light=None,
        reflectance=None,
        energies={"total": 1.0},
        evaluations=3,
        silhouette_overlap=0.9,
        measurements=(
            Measurement(
                name="waist_girth",
                value=80.0 + len(job.options.points),
                unit="cm",
                standard_error=1.0,
                given=False,
                definition="At the navel.",
                source="ISO 8559-1",
            ),
            *_given(job.options),
        ),
        stages=(),
        limb_facing=(),
        assumptions=(Assumption(quantity="focal_length_px", value=700.0, reason="Unknown."),),
        warnings=(),
        stage_seconds={"observation": 0.1},
        artifacts=(),
    )


def _given(options: FitOptions) -> tuple[Measurement, ...]:
    known = dict(options.measurements)
    if options.weight_kg is not None:
        known["weight"] = options.weight_kg
    return tuple(
        Measurement(
            name=name,
            value=each.value if isinstance(each, UncertainMeasurement) else each,
            unit="kg" if name == "weight" else "cm",
            standard_error=each.standard_error if isinstance(each, UncertainMeasurement) else 0.0,
            given=True,
            definition="As given.",
            source="The caller",
        )
        for name, each in known.items()
    )
