"""The fitted person, the body model and the result, from the files of the fit."""

from pathlib import Path

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
