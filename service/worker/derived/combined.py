"""One person from several of their pictures: one shape, and pose and light in each picture."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace

from api_schemas.derivation_kinds.combined import CombinedOptions, CombinedResult
from api_schemas.requests import FitOptions
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
from fitter.fits.equipment import Equipment
from fitter.fits.pipeline import fit
from fitter.person.fitted_person import FittedPerson
from fitter.person.several_pictures import (
    CombinedShape,
    combined_shape,
    known_covariance,
    told_differently,
)
from fitter.request import Choices, FitRequest, StartingBody
from fitter.result import FittedView
from fitter.vocabulary.measurements import STATURE
from service.jobs.inputs import IMAGE, MASK, PERSON, REQUEST, RESULT
from service.worker.derived.person import person_and_operators
from service.worker.pipeline_port import DerivationInput, DerivationOutput
from service.worker.translate import (
    combined_picture,
    known_measurements,
    measurement_results,
    person,
    view,
)

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
    first, operators = person_and_operators(job.inputs[PERSON], job.models)
    people = [first, *(FittedPerson.from_bytes(each[PERSON]) for each in pictures[1:])]
    fused = combined_shape(people)
    equipment = Equipment(models=job.models, detector_weights=job.detector)
    found = fit(
        _request(pictures, people, job.max_pixels),
        equipment,
        observer=lambda progress: observe(_FITTED * progress.fraction),
    )
    model = operators.model
    measuring = equipment.model(first.gender).measuring
    body = found.canonical_vertices
    assert job.fit_id is not None
    return DerivationOutput(
        result=CombinedResult(
            pictures=len(people),
            shape=tuple(found.shape.tolist()),
            bodies=tuple(
                combined_picture(
                    each.found, number=number, fit_id=fit_id, part_names=model.part_names
                )
                for number, (each, fit_id) in enumerate(
                    zip(found.views, (job.fit_id, *options.fits), strict=True), start=1
                )
            ),
            measurements=measurement_results(found.measurements, found.given),
            agreement=fused.agreement,
            warnings=_warnings(fused, options),
            artifacts=(),
        ),
        artifacts={
            "body_combined.glb": plain_glb(
                body,
                model,
                name="body_combined",
                frame=Frame.STANDING,
                extras={"pictures": len(people)},
                reflectance=found.person.reflectance,
                albedo_rgb=found.person.albedo_rgb,
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
        | _files_of_pictures(found.views, model, [each[IMAGE] for each in pictures]),
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


def _request(
    pictures: Sequence[Mapping[str, bytes]], people: Sequence[FittedPerson], max_pixels: int
) -> FitRequest:
    """What the fits were asked for, each beginning with the body it ended with.

    Without direct search, for the searches are near their end.

    Raises
    ------
    InvalidInputError
        ``fits-unusable``, if the fits were told different things of the person.
    """
    asked = [FitOptions.model_validate_json(each[REQUEST]) for each in pictures]
    for number, each in enumerate(asked):
        if _told(each) != _told(asked[0]):
            raise told_differently(number)
    return FitRequest(
        person=person(asked[0]),
        views=tuple(
            replace(
                view(options, image=inputs[IMAGE], mask=inputs.get(MASK)),
                start=StartingBody(body=before.body, shape_covariance=known_covariance(before)),
            )
            for options, inputs, before in zip(asked, pictures, people, strict=True)
        ),
        choices=Choices(force=True, max_pixels=max_pixels),
    )


def _told(options: FitOptions) -> dict[str, tuple[float, float]]:
    """The height and what else was said of the person, with its standard error."""
    told = {
        name: (known.value, known.standard_error)
        for name, known in known_measurements(options).items()
    }
    return told if options.height_m is None else {STATURE: (options.height_m, 0.0), **told}


def _files_of_pictures(
    views: Sequence[FittedView], model: BodyModel, images: Sequence[bytes]
) -> dict[str, bytes]:
    files: dict[str, bytes] = {}
    for number, (each, image) in enumerate(zip(views, images, strict=True), start=1):
        files[f"body_posed_{number}.glb"] = body_posed_glb(each.found, model)
        files[f"overlay_{number}.png"] = overlay_png(each.found, model=model, image=image)
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
