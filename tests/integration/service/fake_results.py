"""What the simulated pipeline finds."""

from collections.abc import Sequence

from api_schemas.fit import FitRequest
from api_schemas.person import Person, UncertainMeasurement
from api_schemas.results import (
    BodyResult,
    CameraResult,
    FitResult,
    Measurement,
    Stage,
    ViewResult,
)
from fitter.vocabulary.choices import ViewKind
from fitter.vocabulary.outcomes import FocalLengthSource, Outcome, Verdict
from fitter.vocabulary.remarks import Note, assumed
from service.jobs.inputs import BODY, BODY_POSED, OVERLAY, PERSON, SEGMENTATION, of_view

BODY_RESULT = BodyResult(
    pose={"pelvis": (0.0, 0.0, 0.0)},
    translation_m=(0.0, 0.0, 3.0),
    shape=(0.0, 0.0),
)


def fit_result(asked: FitRequest) -> FitResult:
    waist = _measurement("waist_girth", 80.0 + len(asked.views[0].points), "cm", 1.0)
    return FitResult(
        gender=asked.gender,
        height_m=asked.height_m or 1.7,
        cues=asked.cues,
        optimizer=asked.optimizer,
        energies={"total": 1.0},
        evaluations=3,
        measurements=(waist, *_given(asked)),
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
        files[of_view(number, BODY_POSED)] = b"glTF" + bytes([number])
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


def _given(asked: Person) -> tuple[Measurement, ...]:
    known = dict(asked.measurements)
    if asked.weight_kg is not None:
        known["weight"] = asked.weight_kg
    return tuple(
        _measurement(name, each.value, "cm", each.standard_error, given=True)
        if isinstance(each, UncertainMeasurement)
        else _measurement(name, each, "kg" if name == "weight" else "cm", 0.0, given=True)
        for name, each in known.items()
    )


def _measurement(
    name: str, value: float, unit: str, error: float, *, given: bool = False
) -> Measurement:
    return Measurement(
        name=name,
        value=value,
        unit=unit,
        standard_error=error,
        low=value - 1.96 * error,
        high=value + 1.96 * error,
        given=given,
        definition="As given." if given else "At the navel.",
        source="The caller" if given else "ISO 8559-1",
    )
