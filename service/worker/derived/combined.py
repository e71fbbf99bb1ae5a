"""One person from several of their pictures: the shape the fits agree on."""

from collections.abc import Callable, Sequence
from typing import cast

from api_schemas.derivations import CombinedOptions, CombinedResult, DerivationKind
from api_schemas.results import FitResult, FitWarning
from fitter.applications.fitted_person import FittedPerson
from fitter.applications.previews import View, preview
from fitter.applications.several_pictures import CombinedShape, combined_shape
from fitter.arrays import Vertices
from fitter.export.display import png
from fitter.export.plain_gltf import plain_glb
from fitter.fittable import fittable_body
from fitter.measurement.anthropometry import measure
from service.engine.port import Report
from service.inputs import PERSON, RESULT, other_person
from service.worker.derived.person import person_and_instruments
from service.worker.pipeline_port import DerivationInput, DerivationOutput
from service.worker.translate import measurement_results

STAGE = DerivationKind.COMBINED.value


def derive(job: DerivationInput, observe: Callable[[Report], None]) -> DerivationOutput:
    """Combine; see :class:`service.worker.derivers.Deriver`."""
    observe(Report(stage=STAGE, progress=0.0))
    options = cast("CombinedOptions", job.options)
    fit = FitResult.model_validate_json(job.inputs[RESULT])
    first, instruments = person_and_instruments(job.inputs[PERSON], job.models)
    others = [
        FittedPerson.from_bytes(job.inputs[other_person(index)])
        for index in range(len(options.fits))
    ]
    people = [first, *others]
    found = combined_shape(people)
    observe(Report(stage=STAGE, progress=0.3))
    model = instruments.model
    measuring = fittable_body(first.gender, models=job.models).measuring
    given = [each.name for each in fit.measurements if each.given]
    measurements = measure(
        measuring,
        found.shape,
        shape_covariance=found.covariance,
        given=given,
        held=[each.name for each in fit.measurements if each.given and each.standard_error == 0.0],
    )
    body = measuring.canonical.at(found.shape)
    return DerivationOutput(
        result=CombinedResult(
            pictures=len(people),
            shape=tuple(found.shape.tolist()),
            measurements=measurement_results(measurements, given),
            agreement=found.agreement,
            warnings=_warnings(found, options),
            artifacts=(),
        ),
        artifacts={
            "body_combined.glb": plain_glb(
                body,
                model,
                name="body_combined",
                extras={"pictures": len(people)},
                reflectance=first.reflectance,
                albedo_rgb=first.albedo_rgb,
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
        },
    )


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
                f"that of the others as fits of one person do in {100.0 * found.agreement:.2g} % "
                "of cases. Check the pictures and their clicks, or leave that fit out."
            ),
        ),
    )
