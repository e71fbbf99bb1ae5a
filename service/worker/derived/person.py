"""The fitted person, the body model and the result, from the files of the fit."""

from pathlib import Path
from typing import Final

from pydantic import TypeAdapter

from api_schemas.results import FitResult
from api_schemas.scans import ScanResult
from fitter.energies.fitting_operators import FittingOperators
from fitter.fits.prepared_model import prepared_model
from fitter.person.fitted_person import FittedPerson, require_model


def person_and_operators(
    person_file: bytes, models: Path | None
) -> tuple[FittedPerson, FittingOperators]:
    """Read ``person.npz`` and prepare the body model it was fitted with.

    Raises
    ------
    InvalidInputError
        If it was fitted with a different body model from the current one.
    """
    person = FittedPerson.from_bytes(person_file)
    operators = prepared_model(person.gender, models=models).operators
    require_model(person, operators.model)
    return person, operators


_RESULTS: Final[TypeAdapter[FitResult | ScanResult]] = TypeAdapter(FitResult | ScanResult)


def read_result(document: bytes) -> FitResult | ScanResult:
    """Read ``result.json``; what a later version has added to it is passed over."""
    return _RESULTS.validate_json(document, extra="ignore")
