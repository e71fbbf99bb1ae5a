"""A finished fit, as what is made of it sees it, and what is made of one."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Generic, TypeVar

from pydantic import BaseModel

from api_schemas.products.base import ProductResult
from api_schemas.results import Measurement
from fitter.energies.fitting_operators import FittingOperators
from fitter.errors import InvalidInputError
from fitter.fits.equipment import prepared_model
from fitter.measurement.joint_measurements import JointMeasurements, joint_measurements
from fitter.person.fitted_person import FittedPerson, require_model
from fitter.vocabulary.remarks import Note, Remark
from service.jobs.inputs import PERSON, RESULT

Report = Callable[[float], None]
"""Takes how much of the work is done, from 0 to 1."""

Result_co = TypeVar("Result_co", bound=ProductResult, covariant=True)


@dataclass(frozen=True, slots=True, kw_only=True)
class Made(Generic[Result_co]):
    """A product: what there is to say of it, and its files by name."""

    result: Result_co
    files: Mapping[str, bytes]


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class FinishedFit:
    """The fitted person, the body model, and the fit's files.

    ``files`` are those of :func:`service.jobs.inputs.product_inputs` by name, and the part that
    came with the request, if one did. ``models`` is the folder of the body models, None for those
    shipped with the package.
    """

    person: FittedPerson
    operators: FittingOperators
    files: Mapping[str, bytes]
    max_pixels: int
    models: Path | None


def finished_fit(
    files: Mapping[str, bytes], *, max_pixels: int, models: Path | None = None
) -> FinishedFit:
    """Read ``person.npz`` and prepare the body model it was fitted with.

    Raises
    ------
    InvalidInputError
        If it was fitted with a different body model from the current one.
    """
    person = FittedPerson.from_bytes(files[PERSON])
    operators = prepared_model(person.gender, models=models).operators
    require_model(person, operators.model)
    return FinishedFit(
        person=person, operators=operators, files=files, max_pixels=max_pixels, models=models
    )


class _Told(BaseModel):
    """The part of a result's document that says which measurements were given, and withheld."""

    measurements: tuple[Measurement, ...]
    outcome_explanation: str = ""
    warnings: tuple[Remark, ...] = ()


def measured(fit: FinishedFit, needed: Sequence[str] = ()) -> JointMeasurements:
    """Measure the person of a fit, with what is known of the errors; without what it withholds.

    Raises
    ------
    InvalidInputError
        ``fit-unusable`` where all or what is ``needed`` is withheld, or errors are not known.
    """
    told = _Told.model_validate_json(fit.files[RESULT])
    if not told.measurements:
        raise _unusable(
            f"That fit's measurements are withheld. {told.outcome_explanation}".rstrip(),
            "Fit its picture again with `force`.",
        )
    hardly = [each for each in told.warnings if each.code == Note.MEASUREMENTS_WITHHELD]
    withheld = {name for each in hardly for name in each.where}
    if missing := [name for name in needed if name in withheld]:
        reason = f"That fit says too little of {', '.join(missing)}, and withholds it."
        raise _unusable(reason, "Fit its picture again with the weight, or with `force`.")
    if fit.person.shape_covariance is None:
        reason = "The fit does not say how certain its shape is."
        raise _unusable(reason, "Fit the picture again, without `paper`.")
    given = [each for each in told.measurements if each.given]
    found = joint_measurements(
        prepared_model(fit.person.gender, models=fit.models).measuring,
        fit.person.body.shape,
        shape_covariance=fit.person.shape_covariance,
        given=[each.name for each in given],
        held=[each.name for each in given if each.standard_error == 0.0],
    )
    return found.of([name for name in found.names if name not in withheld])


def _unusable(reason: str, remedy: str) -> InvalidInputError:
    return InvalidInputError(code="fit-unusable", field="kind", reason=reason, remedy=remedy)
