"""The fitted person and the body model, from the files of the fit."""

from pathlib import Path

from fitter.applications.fitted_person import FittedPerson, require_model
from fitter.energies.instruments import BodyInstruments
from fitter.fittable import fittable_body


def person_and_instruments(
    person_file: bytes, models: Path | None
) -> tuple[FittedPerson, BodyInstruments]:
    """Read ``person.npz`` and prepare the body model it was fitted with.

    Raises
    ------
    InvalidInputError
        If it was fitted with another body model than there is now.
    """
    person = FittedPerson.from_bytes(person_file)
    instruments = fittable_body(person.gender, models=models).instruments
    require_model(person, instruments.model)
    return person, instruments
