"""The measurements of the person of a finished fit, with what is known of their errors."""

from pydantic import BaseModel

from api_schemas.results import Measurement
from fitter.errors import InvalidInputError
from fitter.fits.prepared_model import prepared_model
from fitter.measurement.joint_measurements import JointMeasurements, joint_measurements
from service.compute.products.finished_fit import FinishedFit
from service.jobs.inputs import RESULT


class _Told(BaseModel):
    """Of the document of a result what says which measurements were given."""

    measurements: tuple[Measurement, ...]
    outcome_explanation: str = ""


def measured(fit: FinishedFit) -> JointMeasurements:
    """Measure the person of a fit.

    Raises
    ------
    InvalidInputError
        ``fit-unusable`` where the fit's measurements are withheld, or it does not know how certain
        its shape is.
    """
    told = _Told.model_validate_json(fit.files[RESULT])
    if not told.measurements:
        raise _unusable(
            f"That fit's measurements are withheld. {told.outcome_explanation}".rstrip(),
            "Fit its picture again with `force`.",
        )
    person = fit.person
    if person.shape_covariance is None:
        reason = "The fit does not say how certain its shape is."
        raise _unusable(reason, "Fit the picture again, without `paper`.")
    given = [each for each in told.measurements if each.given]
    return joint_measurements(
        prepared_model(person.gender, models=fit.models).measuring,
        person.body.shape,
        shape_covariance=person.shape_covariance,
        given=[each.name for each in given],
        held=[each.name for each in given if each.standard_error == 0.0],
    )


def _unusable(reason: str, remedy: str) -> InvalidInputError:
    return InvalidInputError(code="fit-unusable", field="kind", reason=reason, remedy=remedy)
