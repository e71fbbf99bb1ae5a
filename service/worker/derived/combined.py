"""One person from several of their pictures: one shape, and pose and light in each picture."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from uuid import UUID

import numpy as np

from api_schemas.derivation_kinds.combined import CombinedOptions, CombinedResult
from api_schemas.requests import FitOptions, PersonChoices
from api_schemas.results import BodyResult, FitWarning
from api_schemas.scans import ScanOptions, ScanResult
from fitter.applications.previews import View as Shown
from fitter.applications.previews import preview
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
from fitter.parameters import BodyParameters
from fitter.person.fitted_person import FittedPerson
from fitter.person.several_pictures import (
    MOST_PICTURES,
    CombinedShape,
    combined_shape,
    known_covariance,
    told_differently,
)
from fitter.request import Choices, FitRequest, StartingBody, View
from fitter.result import FittedView
from fitter.vocabulary.measurements import STATURE
from service.jobs.inputs import PERSON, REQUEST, RESULT, SentPicture, pictures_of
from service.worker.derived.person import person_and_operators, read_result
from service.worker.fit_results import combined_picture, measurement_results, rounded_parameters
from service.worker.pipeline_port import DerivationInput, DerivationOutput
from service.worker.translate import known_measurements, person, views

_FITTED = 0.95
"""Share of the work that is done once the pictures are fitted, before their files are made."""

LEAST_PERCENT = 0.01
"""Probabilities below this are not distinguished."""


@dataclass(frozen=True, slots=True, kw_only=True)
class _Fitted:
    """A fit or scan that has succeeded: what it was asked, its pictures, and who was found."""

    id: UUID
    options: FitOptions | ScanOptions
    pictures: tuple[SentPicture[bytes], ...]
    person: FittedPerson
    bodies: tuple[BodyParameters, ...]

    def views(self) -> tuple[View, ...]:
        """Its pictures, each with the body that was found in it to begin with."""
        covariance = known_covariance(self.person)
        return tuple(
            replace(view, start=StartingBody(body=body, shape_covariance=covariance))
            for view, body in zip(views(self.options, self.pictures), self.bodies, strict=True)
        )


def derive(
    job: DerivationInput[CombinedOptions], observe: Callable[[float], None]
) -> DerivationOutput[CombinedResult]:
    """Combine; see :class:`service.worker.derivers.Deriver`."""
    options = job.options
    _require_measurements([job.inputs, *job.others])
    assert job.fit_id is not None
    fits = [
        _read(inputs, fit_id)
        for inputs, fit_id in zip(
            [job.inputs, *job.others], (job.fit_id, *options.fits), strict=True
        )
    ]
    first, operators = person_and_operators(job.inputs[PERSON], job.models)
    fused = combined_shape([each.person for each in fits])
    equipment = Equipment(models=job.models, detector_weights=job.detector)
    found = fit(
        _request(fits, job.max_pixels),
        equipment,
        observer=lambda progress: observe(_FITTED * progress.fraction),
    )
    model = operators.model
    measuring = equipment.model(first.gender).measuring
    body = found.canonical_vertices
    of_fits = [each.id for each in fits for _ in each.pictures]
    return DerivationOutput(
        result=CombinedResult(
            pictures=len(found.views),
            shape=rounded_parameters(found.shape),
            bodies=tuple(
                combined_picture(
                    each.found, number=number, fit_id=fit_id, part_names=model.part_names
                )
                for number, (each, fit_id) in enumerate(
                    zip(found.views, of_fits, strict=True), start=1
                )
            ),
            measurements=measurement_results(found.measurements, found.given),
            agreement=round(fused.agreement, 4),
            warnings=_warnings(fused, options),
            artifacts=(),
        ),
        artifacts={
            "body_combined.glb": plain_glb(
                body,
                model,
                name="body_combined",
                frame=Frame.STANDING,
                extras={"pictures": len(found.views)},
                reflectance=found.person.reflectance,
                albedo_rgb=found.person.albedo_rgb,
            ),
            "combined.png": png(
                preview(
                    [
                        *_seen("combined", body),
                        *_seen("by this fit alone", measuring.canonical.at(first.body.shape)),
                    ],
                    model.triangles,
                )
            ),
        }
        | _files_of_pictures(
            found.views, model, [sent.image for each in fits for sent in each.pictures]
        ),
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
        told = read_result(inputs[RESULT])
        if not told.measurements:
            raise InvalidInputError(
                code="fits-unusable",
                field=f"fits.{number - 1}" if number else "kind",
                reason=f"That fit's measurements are withheld. {told.outcome_explanation}",
                remedy="Leave it out, or fit its picture again with `force`.",
            )


def _read(inputs: Mapping[str, bytes], fit_id: UUID) -> _Fitted:
    found = FittedPerson.from_bytes(inputs[PERSON])
    pictures = pictures_of(inputs)
    if len(pictures) == 1:
        options = FitOptions.model_validate_json(inputs[REQUEST])
        bodies = (found.body,)
    else:
        options = ScanOptions.model_validate_json(inputs[REQUEST])
        result = read_result(inputs[RESULT])
        assert isinstance(result, ScanResult)
        bodies = tuple(_body(view.body) for view in result.views)
    return _Fitted(id=fit_id, options=options, pictures=pictures, person=found, bodies=bodies)


def _body(told: BodyResult) -> BodyParameters:
    return BodyParameters(
        pose=np.array([each.rotation for each in told.pose]),
        translation=np.array(told.translation_m),
        shape=np.array(told.shape),
    )


def _request(fits: Sequence[_Fitted], max_pixels: int) -> FitRequest:
    """What the fits were asked for, each beginning with the bodies it ended with.

    Without direct search, for the searches are near their end.

    Raises
    ------
    InvalidInputError
        ``fits-unusable``, if the fits were told different things of the person or have too many
        pictures together.
    """
    asked = [each.options for each in fits]
    for number, each in enumerate(asked):
        if _told(each) != _told(asked[0]):
            raise told_differently(number)
    all_views = tuple(view for each in fits for view in each.views())
    if len(all_views) > MOST_PICTURES:
        raise InvalidInputError(
            code="fits-unusable",
            field="fits",
            reason=f"Together they have {len(all_views)} pictures, more than {MOST_PICTURES}.",
            remedy="Leave some out.",
        )
    return FitRequest(
        person=person(asked[0]),
        views=all_views,
        choices=Choices(force=True, max_pixels=max_pixels),
    )


def _told(options: PersonChoices) -> dict[str, tuple[float, float]]:
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


def _seen(label: str, vertices: Vertices) -> Sequence[Shown]:
    return [
        Shown(label=label, vertices=vertices),
        Shown(label=f"{label}, side", vertices=vertices, degrees=90.0),
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
