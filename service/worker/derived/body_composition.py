"""Body-fat share by published regressions."""

from collections.abc import Callable
from dataclasses import asdict

from api_schemas.derivation_kinds.body_composition import (
    BodyCompositionOptions,
    BodyCompositionResult,
    BodyFatEstimate,
)
from fitter.applications.body_fat import body_fat, body_mass_index
from service.representation.csv_tables import models_csv
from service.worker.derived.measured import measured_person
from service.worker.pipeline_port import DerivationInput, DerivationOutput


def derive(
    job: DerivationInput[BodyCompositionOptions], observe: Callable[[float], None]
) -> DerivationOutput[BodyCompositionResult]:
    """Estimate; see :class:`service.worker.derivers.Deriver`."""
    found = measured_person(job.inputs, job.models, field="kind")
    observe(0.5)
    bmi, bmi_error = body_mass_index(found.measured)
    estimates = tuple(
        BodyFatEstimate(**asdict(each))
        for each in body_fat(found.measured, found.person.gender, job.options.age_years)
    )
    return DerivationOutput(
        result=BodyCompositionResult(
            age_years=job.options.age_years,
            bmi=bmi,
            bmi_standard_error=bmi_error,
            estimates=estimates,
            files=(),
        ),
        files={"body_composition.csv": models_csv(estimates, BodyFatEstimate.model_fields)},
    )
