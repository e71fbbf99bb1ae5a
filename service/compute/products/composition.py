"""Body-fat share by published regressions."""

from api_schemas.csv_tables import models_csv
from api_schemas.products.documents import (
    BodyFatEstimate,
    CompositionOptions,
    CompositionResult,
)
from fitter.applications.composition import body_fat, body_mass_index
from fitter.vocabulary.measurements import STATURE, WEIGHT
from service.compute.products.finished_fit import FinishedFit, Made, Report, measured


def make(fit: FinishedFit, options: CompositionOptions, report: Report) -> Made[CompositionResult]:
    """Estimate."""
    person = measured(fit, (WEIGHT, STATURE))
    report(0.5)
    estimates = tuple(
        BodyFatEstimate(
            name=each.regression.name,
            source=each.regression.source,
            population=each.regression.population,
            percent=each.percent,
            standard_error=each.standard_error,
            withheld=each.withheld,
        )
        for each in body_fat(person, fit.person.gender, options.age_years)
    )
    return Made(
        result=CompositionResult(bmi=round(body_mass_index(person), 2), estimates=estimates),
        files={"composition.csv": models_csv(estimates, BodyFatEstimate.model_fields)},
    )
