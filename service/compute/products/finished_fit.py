"""A finished fit, as what is made of it sees it."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from fitter.energies.fitting_operators import FittingOperators
from fitter.fits.prepared_model import prepared_model
from fitter.person.fitted_person import FittedPerson, require_model
from service.jobs.inputs import PERSON


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
    files: Mapping[str, bytes], *, max_pixels: int, models: Path | None
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
