"""A gender's body model with everything prepared for fitting and measuring."""

from dataclasses import dataclass
from functools import cache
from pathlib import Path

from fitter.body.model import BodyModel
from fitter.energies.fitting_operators import FittingOperators, searched_operators
from fitter.fits.usable_model import model_path, usable_model
from fitter.measurement.anthropometry import MeasuringBody, measuring_body
from fitter.population.measured_population import MeasuredPopulation, measured_population
from fitter.pose_init.landmark_rig import rig_space
from fitter.vocabulary.choices import Gender


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class PreparedModel:
    """A gender's model and what fits need besides.

    Attributes
    ----------
    operators
        Of the whole body: what is drawn and reported.
    searched
        Of the lighter body that searches use.
    measuring, population
        Tapes on the whole body, and what they measure on the people it was learned from.
    """

    operators: FittingOperators
    searched: FittingOperators
    measuring: MeasuringBody
    population: MeasuredPopulation


def prepared_model(gender: Gender, *, models: Path | None = None) -> PreparedModel:
    """A gender's model, prepared once a process, which takes one to two seconds.

    See :func:`usable_model` for the arguments.

    Raises
    ------
    ModelFileError
        If the file is missing, damaged, of the other gender, or lacks something a fit needs.
    """
    return _prepared(model_path(gender, models=models), gender)


@cache
def _prepared(source: Path, gender: Gender) -> PreparedModel:
    prepared = _prepare(usable_model(gender, models=source.parent))
    # Found once here, every process forked later has it.
    rig_space(prepared.searched.model)
    return prepared


def _prepare(model: BodyModel) -> PreparedModel:
    searched = searched_operators(model)
    assert searched.whole is not None
    operators = searched.whole.operators
    measuring = measuring_body(model, operators.evaluator)
    return PreparedModel(
        operators=operators,
        searched=searched,
        measuring=measuring,
        population=measured_population(measuring),
    )
