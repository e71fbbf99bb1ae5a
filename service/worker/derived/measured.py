"""The measurements of the person of a finished fit, with what is known of their errors."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from pydantic import BaseModel

from api_schemas.results import Measurement
from fitter.errors import InvalidInputError
from fitter.fits.prepared_model import prepared_model
from fitter.measurement.joint_measurements import JointMeasurements, joint_measurements
from fitter.person.fitted_person import FittedPerson
from service.jobs.inputs import PERSON, RESULT
from service.worker.derived.person import person_and_operators


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class MeasuredPerson:
    """A fitted person and all that is measured of them."""

    person: FittedPerson
    measured: JointMeasurements


class _Told(BaseModel):
    """Of the document of a result what says which measurements were given."""

    measurements: tuple[Measurement, ...]
    outcome_explanation: str = ""


def measured_person(
    inputs: Mapping[str, bytes], models: Path | None, *, field: str
) -> MeasuredPerson:
    """Measure the person of a fit; ``field`` of the request names the fit.

    Raises
    ------
    InvalidInputError
        ``fits-unusable`` where the fit's measurements are withheld, or it does not know how certain
        its shape is; or as :func:`service.worker.derived.person.person_and_operators`.
    """
    told = _Told.model_validate_json(inputs[RESULT])
    if not told.measurements:
        raise _unusable(
            field,
            f"That fit's measurements are withheld. {told.outcome_explanation}".rstrip(),
            "Fit its picture again with `force`.",
        )
    person, _ = person_and_operators(inputs[PERSON], models)
    if person.shape_covariance is None:
        raise _unusable(
            field,
            "The fit does not say how certain its shape is.",
            "Fit the picture again, without `paper`.",
        )
    given = [each for each in told.measurements if each.given]
    return MeasuredPerson(
        person=person,
        measured=joint_measurements(
            prepared_model(person.gender, models=models).measuring,
            person.body.shape,
            shape_covariance=person.shape_covariance,
            given=[each.name for each in given],
            held=[each.name for each in given if each.standard_error == 0.0],
        ),
    )


def _unusable(field: str, reason: str, remedy: str) -> InvalidInputError:
    return InvalidInputError(code="fits-unusable", field=field, reason=reason, remedy=remedy)
