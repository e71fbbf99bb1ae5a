"""A scan between two translations: pictures and what is asked of them, one body and its files."""

from collections.abc import Callable, Sequence

from api_schemas import requests as wire_request
from api_schemas import results as wire
from api_schemas import scans as wire_scan
from api_schemas.problems import FieldProblem
from fitter.applications.previews import View, preview
from fitter.body.model import BodyModel
from fitter.errors import DetectorUnavailableError, InvalidInputError
from fitter.export import overlay_png, tapes_of
from fitter.export.display import png
from fitter.export.gltf import body_posed_glb
from fitter.export.gltf_document import Frame
from fitter.export.pictures import drawing_camera, mask_levels
from fitter.export.plain_gltf import plain_glb
from fitter.fits.equipment import Equipment
from fitter.fits.pipeline import fit
from fitter.fits.prepared_model import PreparedModel
from fitter.fits.progress import Stage
from fitter.request import FitRequest
from fitter.result import FitResult, FittedView
from fitter.vocabulary.choices import ViewKind
from fitter.vocabulary.outcomes import Verdict
from service.engine.port import Report
from service.jobs.inputs import BODY_POSED, OVERLAY, PERSON, SEGMENTATION, file_of
from service.worker import translate
from service.worker.findings import finding_results
from service.worker.pipeline_port import ScanInput, ScanOutput, ScanPicture, UnusableInputError

_FITTED = 0.96
"""Share of the work that is done once the body is found, before its files are made."""

_SEEN_FROM = (("front", 0.0), ("side", 90.0), ("back", 180.0))
"""What the preview shows, and how far the onlooker has walked round, degrees."""

_WORSE = (Verdict.PLAUSIBLE, Verdict.IMPLAUSIBLE, Verdict.NO_PERSON)


def scanned(job: ScanInput, observe: Callable[[Report], None]) -> ScanOutput:
    """Measure; see :class:`service.worker.pipeline_port.Pipeline`."""
    equipment = Equipment(models=job.models, detector_weights=job.detector)
    try:
        found = fit(
            _request(job),
            equipment,
            observer=lambda progress: observe(translate.report(progress)),
        )
        observe(Report(stage=Stage.EXPORT.value, progress=_FITTED))
        prepared = equipment.model(found.person.gender)
        files = _files(found, prepared, job.pictures)
    except InvalidInputError as error:
        raise UnusableInputError(translate.field_problem(error)) from error
    except DetectorUnavailableError as error:
        raise UnusableInputError(_undetected(job, error)) from error
    return ScanOutput(result=_result(job, found, prepared.operators.model), artifacts=files)


def _request(job: ScanInput) -> FitRequest:
    asked = [job.options.of_view(number) for number in range(len(job.pictures))]
    return FitRequest(
        person=translate.person(job.options),
        views=tuple(
            translate.view(each, image=picture.image, mask=picture.mask, kind=said.view)
            for each, said, picture in zip(asked, job.options.views, job.pictures, strict=True)
        ),
        choices=translate.choices(asked[0], max_pixels=job.max_pixels),
    )


def _undetected(job: ScanInput, error: DetectorUnavailableError) -> FieldProblem:
    """Of the first view whose points were to be proposed."""
    number = next(n for n, view in enumerate(job.options.views) if view.complete_points)
    told = translate.detector_problem(error)
    return told.model_copy(update={"field": f"views.{number}.{told.field}"})


def _result(job: ScanInput, found: FitResult, model: BodyModel) -> wire_scan.ScanResult:
    assert found.alone is not None
    first = found.views[0].found
    worst = max((view.found for view in found.views), key=lambda each: _WORSE.index(each.verdict))
    return wire_scan.ScanResult(
        gender=job.options.gender,
        height_m=first.height_m,
        cues=wire_request.Cues(first.cues.value),
        verdict=wire.Verdict(worst.verdict.value),
        outcome_explanation=worst.outcome_explanation,
        shape=tuple(found.shape.tolist()),
        views=tuple(_view(number, view, model) for number, view in enumerate(found.views)),
        measurements=translate.measurement_results(found.measurements, found.given),
        agreement=found.alone.agreement,
        assumptions=translate.assumption_results(found.assumptions),
        warnings=translate.warning_results(found.warnings),
        artifacts=(),
    )


def _view(number: int, view: FittedView, model: BodyModel) -> wire_scan.ScannedView:
    found = view.found
    return wire_scan.ScannedView(
        number=number,
        view=view.kind or ViewKind.OTHER,
        outcome_explanation=found.outcome_explanation,
        verdict=wire.Verdict(found.verdict.value),
        camera=translate.fitted_camera(view.camera, found.person.tilt),
        focal_length_source=wire.FocalLengthSource(view.focal_length_source.value),
        findings=finding_results(view.findings),
        stance=translate.stance_result(found.person),
        assumptions=translate.assumption_results(view.assumptions),
        warnings=translate.warning_results(view.warnings),
        **translate.in_picture(found, model.part_names),
    )


def _files(
    found: FitResult, prepared: PreparedModel, pictures: Sequence[ScanPicture]
) -> dict[str, bytes]:
    model = prepared.operators.model
    person = found.views[0].found.person
    body = found.canonical_vertices
    files = {
        "body_canonical.glb": plain_glb(
            body,
            model,
            name="body_canonical",
            frame=Frame.STANDING,
            extras={"pictures": len(pictures)},
            reflectance=person.reflectance,
            albedo_rgb=person.albedo_rgb,
        ),
        "scan.png": png(
            preview(
                [
                    View(label=label, vertices=body, degrees=degrees)
                    for label, degrees in _SEEN_FROM
                ],
                model.triangles,
            )
        ),
        "tapes.json": tapes_of(body, found.shape, prepared.measuring),
        PERSON: person.to_bytes(),
    }
    for number, (view, picture) in enumerate(zip(found.views, pictures, strict=True)):
        camera = drawing_camera(view.found.person.camera)
        files |= {
            file_of(BODY_POSED, number): body_posed_glb(view.found, model),
            file_of(OVERLAY, number): overlay_png(view.found, model=model, image=picture.image),
            file_of(SEGMENTATION, number): png(
                mask_levels(view.pictures.segmentation, view.camera, camera)
            ),
        }
    return files
