"""What the simulated pipeline finds: results of fits and scans."""

from collections.abc import Sequence
from typing import Any

from api_schemas.known import UncertainMeasurement
from api_schemas.requests import FitOptions, PersonChoices
from api_schemas.results import (
    Assumption,
    BodyResult,
    FitResult,
    FittedCameraResult,
    Measurement,
    PartRotation,
    Stage,
    StageBody,
)
from api_schemas.scans import ScannedView, ScanOptions, ScanResult, ScanStage
from fitter.vocabulary.outcomes import FocalLengthSource, Outcome, Verdict
from service.jobs.inputs import BODY_POSED, OVERLAY, PERSON, SEGMENTATION, file_of


def fit_result(options: FitOptions) -> FitResult:
    return FitResult(
        **_person(options, points=len(options.points)),
        **_view(),
        view=options.view,
        stages=(Stage(**_stage(), **_stage_body()),),
        assumptions=(Assumption(quantity="focal_length_px", value=700.0, reason="Unknown."),),
        warnings=(),
    )


def scan_result(options: ScanOptions) -> ScanResult:
    view = _view()
    return ScanResult(
        **_person(options, points=len(options.views[0].points)),
        verdict=view["verdict"],
        outcome_explanation=view["outcome_explanation"],
        shape=view["body"].shape,
        views=tuple(
            ScannedView(number=number, view=each.view, assumptions=(), warnings=(), **view)
            for number, each in enumerate(options.views)
        ),
        stages=(ScanStage(**_stage(), views=(StageBody(**_stage_body()),) * len(options.views)),),
        agreement=0.5,
        assumptions=(),
        warnings=(),
    )


def scan_files(images: Sequence[bytes]) -> dict[str, bytes]:
    files = {"body_canonical.glb": b"glTF", "scan.png": b"PNG", PERSON: images[0]}
    for number, image in enumerate(images):
        files[file_of(BODY_POSED, number)] = b"glTF" + bytes([number])
        files[file_of(OVERLAY, number)] = image
        files[file_of(SEGMENTATION, number)] = b"PNG"
    return files


def _person(options: PersonChoices, *, points: int) -> dict[str, Any]:
    waist = Measurement(
        name="waist_girth",
        value=80.0 + points,
        unit="cm",
        standard_error=1.0,
        given=False,
        definition="At the navel.",
        source="ISO 8559-1",
    )
    return {
        "gender": options.gender,
        "height_m": options.height_m or 1.7,
        "cues": options.cues,
        "optimizer": options.optimizer,
        "energies": {"total": 1.0},
        "evaluations": 3,
        "measurements": (waist, *_given(options)),
        "stage_seconds": {"observation": 0.1},
        "artifacts": (),
    }


def _view() -> dict[str, Any]:
    camera = FittedCameraResult(
        focal_length_px=700.0, centre_x=320.0, centre_y=240.0, width=640, height=480
    )
    return {
        "outcome": Outcome.CONVERGED,
        "outcome_explanation": "The energy stopped decreasing.",
        "verdict": Verdict.PLAUSIBLE,
        "camera": camera,
        "image_camera": camera,
        "focal_length_source": FocalLengthSource.ASSUMED,
        "body": BodyResult(
            pose=(PartRotation(part="pelvis", rotation=(0.0, 0.0, 0.0)),),
            translation_m=(0.0, 0.0, 3.0),
            shape=(0.0, 0.0),
        ),
        "stance": None,
        "light": None,
        "reflectance": None,
        "silhouette_overlap": 0.9,
        "limb_facing": (),
        "findings": (),
    }


def _stage() -> dict[str, Any]:
    return {"name": "SE", "energies": {"total": 2.0}, "measurements": ()}


def _stage_body() -> dict[str, Any]:
    return {name: _view()[name] for name in StageBody.model_fields}


def _given(options: PersonChoices) -> tuple[Measurement, ...]:
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
