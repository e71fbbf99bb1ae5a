"""What the simulated pipeline finds: results of fits and scans."""

from collections.abc import Sequence

from api_schemas.known import UncertainMeasurement
from api_schemas.requests import FitOptions
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
from service.jobs.inputs import (
    BODY_POSED,
    OVERLAY,
    PERSON,
    SEGMENTATION,
    file_of,
)
from service.worker.pipeline_port import (
    PipelineInput,
    ScanInput,
    ScanOutput,
)


def fit_result(job: PipelineInput) -> FitResult:
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


def scan_output(job: ScanInput, fits: Sequence[FitResult]) -> ScanOutput:
    """A scan whose views are these fits."""
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
