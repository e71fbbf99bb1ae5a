"""The most probable body for a gender and known measurements, and how much is left open."""

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from scipy.special import chdtrc

from fitter.arrays import Shape, Vertices
from fitter.energies.shape_terms import height_extrapolation
from fitter.measurement.anthropometry import measure
from fitter.measurement.definitions import Measurement
from fitter.population.conditional_shape import MeasuredPopulation, height_warnings
from fitter.population.known import conditioned_population
from fitter.request import KnownMeasurement
from fitter.vocabulary.measurements import STATURE
from fitter.vocabulary.remarks import Remark


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class BodyEstimate:
    """A body without a picture.

    Attributes
    ----------
    shape
        (n,) coefficients, standard deviations.
    canonical_vertices
        In the canonical pose, body frame, metres.
    measurements
        In the order of the definitions; the standard error is how much people like this differ.
    plausibility
        Share of the population whose same measurements are together at least as unusual; 1 if
        nothing was known.
    warnings
        Of a height that few have.
    """

    shape: Shape
    canonical_vertices: Vertices
    measurements: tuple[Measurement, ...]
    plausibility: float
    warnings: tuple[Remark, ...]


def estimate_body(
    population: MeasuredPopulation, known: Mapping[str, KnownMeasurement]
) -> BodyEstimate:
    """Estimate a body from its known measurements, from none to all of them.

    Standard errors are the population's spread given what is known, in the model's own terms (a
    Gaussian, linearised at the estimate): how people differ who agree in what was given. They do
    not include the error of the model itself, but are wider where nobody surveyed was of the height
    (:func:`fitter.energies.shape_terms.height_extrapolation`).

    Raises
    ------
    InvalidInputError
        If a name is not measured, or nobody has such measurements.
    """
    conditioned = conditioned_population(population, known)
    covariance = height_extrapolation(float(conditioned.shape[0])) * conditioned.covariance
    measurements = measure(population.body, conditioned.shape)
    height_cm = next(each.value for each in measurements if each.name == STATURE)
    # What is held exactly has no spread; rounding would leave a millionth of a unit.
    held = {name for name, each in known.items() if not each.standard_error}
    spreads = {
        name: 0.0 if name in held else float(np.sqrt(max(variance, 0.0)))
        for name, variance in zip(
            population.names,
            np.einsum("kn,nj,kj->k", conditioned.jacobian, covariance, conditioned.jacobian),
            strict=True,
        )
    }
    return BodyEstimate(
        shape=conditioned.shape,
        canonical_vertices=population.body.canonical.at(conditioned.shape),
        measurements=tuple(
            replace(each, standard_error=spreads[each.name]) for each in measurements
        ),
        plausibility=float(chdtrc(len(known), conditioned.squared_distance)) if known else 1.0,
        warnings=height_warnings(population, height_cm / 100.0),
    )
