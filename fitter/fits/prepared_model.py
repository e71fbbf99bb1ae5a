"""A gender's body model with everything prepared for fitting and measuring."""

from dataclasses import dataclass
from functools import cache
from pathlib import Path

from fitter.body.model import BodyModel
from fitter.energies.fitting_operators import FittingOperators, fitting_operators
from fitter.fits.usable_model import usable_model
from fitter.measurement.anthropometry import MeasuringBody, measuring_body
from fitter.population.measured_population import MeasuredPopulation, measured_population
from fitter.request import Gender


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class PreparedModel:
    """What a fit needs of a gender."""

    operators: FittingOperators
    measuring: MeasuringBody
    population: MeasuredPopulation


def prepared_model(gender: Gender, *, models: Path | None = None) -> PreparedModel:
    """A gender's model, loaded and prepared once a process; see :func:`usable_model`.

    Raises
    ------
    ModelFileError
        If the file is missing, damaged, of the other gender, or lacks something a fit needs.
    """
    return _prepared(usable_model(gender, models=models))


@cache
def _prepared(model: BodyModel) -> PreparedModel:
    operators = fitting_operators(model)
    measuring = measuring_body(model, operators.evaluator)
    return PreparedModel(
        operators=operators, measuring=measuring, population=measured_population(measuring)
    )
