"""One person from several of their pictures: one shape, and pose and light in each picture."""

from collections.abc import Callable, Mapping, Sequence

from api_schemas.derivation_kinds.combined import CombinedOptions, CombinedResult
from api_schemas.requests import FitOptions, OptimizerKind
from api_schemas.results import FitResult, FitWarning
from fitter.applications.previews import View, preview
from fitter.arrays import Vertices
from fitter.body.model import BodyModel
from fitter.errors import InvalidInputError
from fitter.export import overlay_png
from fitter.export.display import png
from fitter.export.gltf import body_posed_glb
from fitter.export.gltf_document import Frame
from fitter.export.plain_gltf import plain_glb
from fitter.fits.joint_fit import joint_fit
from fitter.fits.prepared_model import prepared_model
from fitter.measurement.anthropometry import measure
from fitter.person.fitted_person import FittedPerson
from fitter.person.several_pictures import CombinedShape
from fitter.request import FitRequest
from fitter.result import PictureFit
from service.jobs.inputs import IMAGE, MASK, PERSON, REQUEST, RESULT
from service.worker.derived.person import person_and_operators
from service.worker.pipeline_port import DerivationInput, DerivationOutput
from service.worker.translate import combined_picture, fit_request, measurement_results

_FITTED = 0.95
"""Share of the work that is done once the pictures are fitted, before their files are made."""

LEAST_PERCENT = 0.01
"""Probabilities below this are not distinguished."""


def derive(
    job: DerivationInput[CombinedOptions], observe: Callable[[float], None]
) -> DerivationOutput[CombinedResult]:
    """Combine; see :class:`service.worker.derivers.Deriver`."""
    options = job.options
    pictures = [job.inputs, *job.others]
    _require_measurements(pictures)
    fit = FitResult.model_validate_json(job.inputs[RESULT])
    first, operators = person_and_operators(job.inputs[PERSON], job.models)
    people = [first, *(FittedPerson.from_bytes(each[PERSON]) for each in pictures[1:])]
    found = joint_fit(
        people,
        [_request(each, job.max_pixels) for each in pictures],
        models=job.models,
        detector_weights=job.detector,
        observe=lambda share: observe(_FITTED * share),
    )
    model = operators.model
    measuring = prepared_model(first.gender, models=job.models).measuring
    given = [each.name for each in fit.measurements if each.given]
    measurements = measure(
        measuring,
        found.shape,
        shape_covariance=found.covariance,
        given=given,
        held=[each.name for each in fit.measurements if each.given and each.standard_error == 0.0],
    )
    body = measuring.canonical.at(found.shape)
    assert job.fit_id is not None
    return DerivationOutput(
        result=CombinedResult(
            pictures=len(people),
            shape=tuple(found.shape.tolist()),
            bodies=tuple(
                combined_picture(each, number=number, fit_id=fit_id, part_names=model.part_names)
                for number, (each, fit_id) in enumerate(
                    zip(found.pictures, (job.fit_id, *options.fits), strict=True), start=1
                )
            ),
            measurements=measurement_results(measurements, given),
            agreement=found.fused.agreement,
            warnings=_warnings(found.fused, options),
            artifacts=(),
        ),
        artifacts={
            "body_combined.glb": plain_glb(
                body,
                model,
                name="body_combined",
                frame=Frame.STANDING,
                extras={"pictures": len(people)},
                reflectance=found.pictures[0].person.reflectance,
                albedo_rgb=found.pictures[0].person.albedo_rgb,
            ),
            "combined.png": png(
                preview(
                    [
                        *_views("combined", body),
                        *_views("by this fit alone", measuring.canonical.at(first.body.shape)),
                    ],
                    model.triangles,
                )
            ),
        }
        | _files_of_pictures(found.pictures, model, [each[IMAGE] for each in pictures]),
    )


def _require_measurements(pictures: Sequence[Mapping[str, bytes]]) -> None:
    """Refuse fits whose measurements were withheld: what they found is no person's shape.

    Raises
    ------
    InvalidInputError
        ``fits-unusable``.
    """
    for number, inputs in enumerate(pictures):
        # Jobs accepted by an earlier version have no copies of the other fits' results.
        if RESULT not in inputs:
            continue
        fit = FitResult.model_validate_json(inputs[RESULT])
        if not fit.measurements:
            raise InvalidInputError(
                code="fits-unusable",
                field=f"fits.{number - 1}" if number else "kind",
                reason=f"That fit's measurements are withheld. {fit.outcome_explanation}",
                remedy="Leave it out, or fit its picture again with `force`.",
            )


def _request(inputs: Mapping[str, bytes], max_pixels: int) -> FitRequest:
    """What the fit was asked for, without direct search: it starts where the fit ended."""
    options = FitOptions.model_validate_json(inputs[REQUEST])
    return fit_request(
        options.model_copy(update={"optimizer": OptimizerKind.GAUSS_NEWTON}),
        image=inputs[IMAGE],
        mask=inputs.get(MASK),
        max_pixels=max_pixels,
    )


def _files_of_pictures(
    bodies: Sequence[PictureFit], model: BodyModel, images: Sequence[bytes]
) -> dict[str, bytes]:
    files: dict[str, bytes] = {}
    for number, (body, image) in enumerate(zip(bodies, images, strict=True), start=1):
        files[f"body_posed_{number}.glb"] = body_posed_glb(body, model)
        files[f"overlay_{number}.png"] = overlay_png(body, model=model, image=image)
    return files


def _views(label: str, vertices: Vertices) -> Sequence[View]:
    return [
        View(label=label, vertices=vertices),
        View(label=f"{label}, side", vertices=vertices, degrees=90.0),
    ]


def _warnings(found: CombinedShape, options: CombinedOptions) -> tuple[FitWarning, ...]:
    if not found.doubtful:
        return ()
    which = "this fit" if found.differing == 0 else f"fit {options.fits[found.differing - 1]}"
    return (
        FitWarning(
            code="different-people",
            message=(
                f"The pictures seem to show different people: the body of {which} differs from "
                f"that of the others as fits of one person do in {_percent(found.agreement)} "
                "of cases. Check the pictures and their clicks, or leave that fit out."
            ),
        ),
    )


def _percent(share: float) -> str:
    percent = 100.0 * share
    return f"less than {LEAST_PERCENT} %" if percent < LEAST_PERCENT else f"{percent:.2g} %"
