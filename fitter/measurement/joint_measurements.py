"""Measurements of one body together: their values and how their errors go along with one another.

Standard errors alone do not say that a waist that is estimated too large comes with hips that are:
whoever derives something from several measurements needs their covariance.
"""

from collections.abc import Collection, Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from fitter.arrays import Shape
from fitter.measurement.anthropometry import (
    MeasuringBody,
    measurement_jacobian,
    measurement_values,
)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class JointMeasurements:
    """Measurements of one person, as a Gaussian.

    Attributes
    ----------
    names, units
        Of the rows: a measurement's name, ``cm`` or ``kg``.
    values
        (k,) in their units.
    covariance
        (k, k) of their errors.
    given
        Names of those that were given, not inferred.
    """

    names: tuple[str, ...]
    units: tuple[str, ...]
    values: Float[np.ndarray, " k"]
    covariance: Float[np.ndarray, "k k"]
    given: tuple[str, ...] = ()

    @property
    def standard_errors(self) -> Float[np.ndarray, " k"]:
        """Standard deviation of each measurement's error, in its unit."""
        return np.sqrt(np.maximum(np.diag(self.covariance), 0.0))

    def of(self, names: Sequence[str]) -> "JointMeasurements":
        """Those of these names alone, in their order."""
        rows = [self.names.index(name) for name in names]
        return JointMeasurements(
            names=tuple(names),
            units=tuple(self.units[row] for row in rows),
            values=self.values[rows],
            covariance=self.covariance[np.ix_(rows, rows)],
            given=tuple(name for name in self.given if name in names),
        )


def joint_measurements(
    body: MeasuringBody,
    shape: Shape,
    *,
    shape_covariance: Float[np.ndarray, "n n"],
    given: Collection[str] = (),
    held: Collection[str] = (),
) -> JointMeasurements:
    """All measurements of a body, with the covariance J Σ Jᵀ + diag(u²) of their errors.

    J is the derivative of the measurements by the shape, Σ the shape's covariance and u how much
    people differ in each measurement from the nearest body of the model. What one measurement has
    unexplained is taken to be independent of what another has. ``given`` and ``held`` are as in
    :func:`fitter.measurement.anthropometry.measure`, with whose standard errors these agree.
    """
    jacobian = measurement_jacobian(body, shape)
    names = tuple(each.about.name for each in body.definitions)
    unexplained = np.where([name in given for name in names], 0.0, body.unexplained)
    free = np.array([name not in held for name in names], dtype=np.float64)
    covariance = jacobian @ shape_covariance @ jacobian.T + np.diag(unexplained**2)
    covariance *= np.outer(free, free)
    return JointMeasurements(
        names=names,
        units=tuple(each.about.unit.value for each in body.definitions),
        values=measurement_values(body, shape),
        covariance=0.5 * (covariance + covariance.T),
        given=tuple(name for name in names if name in given),
    )
