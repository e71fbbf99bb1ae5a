"""Age, stature and body mass index of civilian adults, and draws of them.

Soldiers are young and fit, users are not only soldiers. The National Health and Nutrition
Examination Survey (NHANES 2017-2018, US Centers for Disease Control and Prevention, public domain)
measured 2,647 women and 2,528 men from 18 to 80 and older. Its statistics by age are kept in
``data/civilian_statistics.json``: unweighted counts of people from 18 up, 25, 35, 45, 55, 65 and 75
years, which hold more old people and more ancestries than the country does.

Of a civilian we draw age, stature and weight; :mod:`fitter.training.surveys.survey` adds all else.
"""

import json
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import numpy as np
from jaxtyping import Float, Integer

AGES = (18.0, 80.0)
"""Years: ages are drawn evenly in between, so that no age is learned worse than another."""

BMI_RANGE = (16.0, 45.0)
"""kg/m²: draws outside are drawn again."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class CivilianStatistics:
    """Means by age group and covariance within it, of one gender.

    Attributes
    ----------
    count
        (a,) people of each age group.
    age
        (a,) their mean age, years, ascending.
    log_stature, log_bmi, log_waist
        (a,) mean natural logarithms: metres, kg/m², metres. The waist is measured above the iliac
        crest.
    log_covariance
        (a, 2, 2) of the logarithms of stature and body mass index.
    """

    count: Integer[np.ndarray, " a"]
    age: Float[np.ndarray, " a"]
    log_stature: Float[np.ndarray, " a"]
    log_bmi: Float[np.ndarray, " a"]
    log_waist: Float[np.ndarray, " a"]
    log_covariance: Float[np.ndarray, "a 2 2"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Civilian:
    """A person by what a form asks: years, metres, kilograms."""

    age: float
    stature: float
    weight: float


def packaged_civilians_path() -> Path:
    """The committed statistics."""
    return Path(__file__).parent / "data" / "civilian_statistics.json"


def load_civilians(path: Path, gender: str) -> CivilianStatistics:
    """Read the statistics of ``female`` or ``male``."""
    content = json.loads(path.read_text())[gender]
    return CivilianStatistics(
        **{name: np.array(content[name]) for name in CivilianStatistics.__dataclass_fields__}
    )


def draw_civilian(statistics: CivilianStatistics, generator: np.random.Generator) -> Civilian:
    """Age drawn evenly; stature and body mass index log-normal at that age.

    Means and covariance are linear in age between the groups' mean ages, and constant beyond.
    """
    age = generator.uniform(*AGES)
    at_age = partial(np.interp, age, statistics.age)
    mean = np.array([at_age(statistics.log_stature), at_age(statistics.log_bmi)])
    entries = [at_age(statistics.log_covariance[:, i, j]) for i, j in ((0, 0), (0, 1), (1, 1))]
    root = np.linalg.cholesky([[entries[0], entries[1]], [entries[1], entries[2]]])
    while True:
        stature, index = np.exp(mean + root @ generator.normal(size=2))
        if BMI_RANGE[0] <= index <= BMI_RANGE[1]:
            return Civilian(
                age=float(age), stature=float(stature), weight=float(index * stature**2)
            )
