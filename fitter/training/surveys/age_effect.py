"""How the survey's measurements go with age among people of one stature and weight.

The models' people are from 18 to 80 years old, soldiers some 30: at the same stature and weight
civilians have wider waists and thinner legs, and differ from the survey by that much rightly.
"""

from collections.abc import Sequence

import numpy as np
from jaxtyping import Float

from fitter.measurement.definitions import MeasurementDefinition
from fitter.training.surveys.civilians import AGES
from fitter.training.surveys.survey import load_statistics, packaged_statistics_path, regression
from fitter.training.surveys.survey_files import SOURCE_NAMES


def age_effect(
    gender: str, definitions: Sequence[MeasurementDefinition]
) -> Float[np.ndarray, " k"]:
    """By how many of the survey's standard deviations people of the training's mean age differ.

    To first order, at the survey's medians; not a number where its statistics lack a field.
    """
    statistics = load_statistics(packaged_statistics_path(), gender)
    by_year = regression(statistics).slope[2]
    median, logarithms = statistics.median, statistics.log_covariance
    ours = {source: name for name, source in SOURCE_NAMES.items()}
    effects = []
    for definition in definitions:
        names = [ours.get(field, field) for field in definition.about.survey.fields]
        if not names or not set(names) <= set(statistics.names):
            effects.append(np.nan)
            continue
        rows = [statistics.names.index(name) for name in names]
        variance = median[rows] @ logarithms[np.ix_(rows, rows)] @ median[rows]
        effects.append(float(median[rows] @ by_year[rows]) / np.sqrt(variance))
    return np.array(effects) * (np.mean(AGES) - statistics.age_mean)
