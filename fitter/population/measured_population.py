"""A body model's population as its measurements see it; prepared once a model."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
from jaxtyping import Float

from fitter.arrays import Shape
from fitter.measurement.anthropometry import (
    MeasuringBody,
    measurement_jacobian,
    measurement_values,
)
from fitter.population.conditional_shape import MeasuredShapes


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
