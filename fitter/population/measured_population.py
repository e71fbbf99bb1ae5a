"""A body model's population as its measurements see it; prepared once a model."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
from jaxtyping import Float

from fitter.arrays import Shape
from fitter.energies.priors import USUAL_HEIGHT_SD, height_extrapolation
from fitter.measurement.anthropometry import (
    MeasuringBody,
    measurement_jacobian,
    measurement_values,
)
from fitter.population.conditional_shape import MeasuredShapes
from fitter.remarks import FitWarning
from fitter.vocabulary.measurements import STATURE


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class MeasuredPopulation:
    """A model's population and what is measured of its people.

    ``names`` and ``units`` follow the rows of ``shapes``.
    """

    body: MeasuringBody
    names: tuple[str, ...]
    units: tuple[str, ...]
    shapes: MeasuredShapes

    def only(self, *names: str) -> "MeasuredPopulation":
        """The same people, of whom nothing else is measured; in the order of the names."""
        rows = [self.names.index(name) for name in names]
        return _population(
            replace(self.body, definitions=tuple(self.body.definitions[row] for row in rows)),
            mean=self.shapes.mean[rows],
            jacobian_at_mean=self.shapes.jacobian_at_mean[rows],
        )


def measured_population(body: MeasuringBody) -> MeasuredPopulation:
    """Measure the mean person of a model; once a model."""
    mean = np.zeros(len(body.canonical.derivative))
    return _population(
        body,
        mean=measurement_values(body, mean),
        jacobian_at_mean=measurement_jacobian(body, mean),
    )


def _population(
    body: MeasuringBody,
    *,
    mean: Float[np.ndarray, " k"],
    jacobian_at_mean: Float[np.ndarray, "k n"],
) -> MeasuredPopulation:
    return MeasuredPopulation(
        body=body,
        names=tuple(definition.about.name for definition in body.definitions),
        units=tuple(definition.about.unit.value for definition in body.definitions),
        shapes=MeasuredShapes(
            measure=partial(_values_of_rows, body),
            jacobian=partial(measurement_jacobian, body),
            mean=mean,
            jacobian_at_mean=jacobian_at_mean,
        ),
    )


def _values_of_rows(
    body: MeasuringBody, shape: Shape, rows: Sequence[int]
) -> Float[np.ndarray, " r"]:
    chosen = replace(body, definitions=tuple(body.definitions[row] for row in rows))
    return measurement_values(chosen, shape)


def height_warnings(population: MeasuredPopulation, height_m: float) -> tuple[FitWarning, ...]:
    """Warn of a height beyond the population's usual ones, and say by how much errors are wider."""
    row = population.names.index(STATURE)
    mean = float(population.shapes.mean[row])
    deviation = float(np.linalg.norm(population.shapes.jacobian_at_mean[row]))
    stature_cm = 100.0 * height_m
    extrapolation = height_extrapolation((stature_cm - mean) / deviation)
    if extrapolation == 1.0:
        return ()
    low, high = mean - USUAL_HEIGHT_SD * deviation, mean + USUAL_HEIGHT_SD * deviation
    return (
        FitWarning(
            code="unusual-height",
            message=(
                f"At {stature_cm:.0f} cm the body is extrapolated: 99.7 % of the people of the "
                f"gender that bodies were learned from are {low:.0f} to {high:.0f} cm tall. "
                f"Standard errors are {np.sqrt(extrapolation):.2f} times as wide. Check height "
                "and gender."
            ),
        ),
    )
