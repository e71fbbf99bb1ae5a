"""Heights that few have: accepted everywhere, and told, because the rest of the body is guessed."""

import numpy as np

from fitter.energies.priors import USUAL_HEIGHT_SD, height_extrapolation
from fitter.population.measured_population import MeasuredPopulation
from fitter.remarks import FitWarning
from fitter.vocabulary.measurements import STATURE


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
