"""A gender's body model with everything prepared for fitting and measuring."""

from dataclasses import dataclass
from functools import cache
from pathlib import Path

from fitter.body.model import BodyModel
from fitter.energies.fitting_operators import FittingOperators, searched_operators
from fitter.fits.usable_model import usable_model
from fitter.measurement.anthropometry import MeasuringBody, measuring_body
from fitter.optimizer.alternation import elimination_ranks
from fitter.population.measured_population import MeasuredPopulation, measured_population
from fitter.pose_init.landmark_rig import rig_space
from fitter.request import Gender


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class PreparedModel:
    """What a fit needs of a gender.

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
    """A gender's model, loaded and prepared once a process; see :func:`usable_model`.

    Raises
    ------
    ModelFileError
        If the file is missing, damaged, of the other gender, or lacks something a fit needs.
    """
    return _prepared(usable_model(gender, models=models))


@cache
def _prepared(model: BodyModel) -> PreparedModel:
    searched = searched_operators(model)
    assert searched.whole is not None
    operators = searched.whole.operators
    # Kept beside the model: found here, every process forked later has them.
    rig_space(searched.model)
    elimination_ranks(searched.shaded)
    elimination_ranks(operators.shaded)
    measuring = measuring_body(model, operators.evaluator)
    return PreparedModel(
        operators=operators,
        searched=searched,
        measuring=measuring,
        population=measured_population(measuring),
    )
