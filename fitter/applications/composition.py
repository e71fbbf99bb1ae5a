"""Body-fat share by published regressions on girths, each with its own error.

*US Navy* (Hodgdon and Beckett 1984, Naval Health Research Center reports 84-11, men, and 84-29,
women), lengths in centimetres, logarithms to base 10; density by girths, then Siri's share of fat:

    men    density = 1.0324 - 0.19077 log(waist at the navel - neck) + 0.15456 log(height)
    women  density = 1.29579 - 0.35004 log(natural waist + hips - neck) + 0.22100 log(height)
    fat = 495 / density - 450,  standard error of the estimate 3.52 (men), 3.72 (women)

*CUN-BAE* (Gómez-Ambrosi et al. 2012, Diabetes Care 35:383-388), of age, sex (women 1, men 0) and
body mass index, standard error 4.66:

    fat = -44.988 + 0.503 age + 10.689 sex + 3.172 bmi - 0.026 bmi² + 0.181 bmi sex
          - 0.02 bmi age - 0.005 bmi² sex + 0.00021 bmi² age

Both in percent of the weight. A regression knows its population alone: outside it nothing is said.
The ages and body mass indices of the Navy's equations are ours, since they were learned from
serving sailors: adults of working age, neither thin nor very heavy. The error that is stated is the
regression's own, added in squares to what the errors of the measurements make of it together.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from jaxtyping import Float

from fitter.measurement.joint_measurements import JointMeasurements
from fitter.vocabulary.choices import Gender
from fitter.vocabulary.measurements import STATURE, WEIGHT

Values = Float[np.ndarray, " k"]

_STEP = 1e-3
"""Centimetres or kilograms: central differences of these formulas are exact to a millionth."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Regression:
    """A published regression as it applies to one gender.

    ``percent`` is given the measurements of ``inputs``, in their order, and the age in years.
    ``error`` is the standard error of its estimate; ``ages`` and ``bmis`` bound its population.
    """

    name: str
    source: str
    population: str
    inputs: tuple[str, ...]
    percent: Callable[[Values, float], float]
    error: float
    ages: tuple[float, float]
    bmis: tuple[float, float]
    needs_age: bool


class BodyFat(NamedTuple):
    """Answer of one regression: percent of the weight, or why it gives none (``withheld``)."""

    regression: Regression
    percent: float | None
    standard_error: float | None
    withheld: tuple[str, ...]


def body_mass_index(person: JointMeasurements) -> float:
    """Weight over squared height, kg per m²."""
    return _bmi(person.of((WEIGHT, STATURE)).values)


def body_fat(
    person: JointMeasurements, gender: Gender, age_years: float | None
) -> tuple[BodyFat, ...]:
    """Body fat of a person by every regression; without an age, that of an adult."""
    bmi = body_mass_index(person)
    return tuple(_estimated(each, person, bmi, age_years) for each in regressions(gender))


def _estimated(
    regression: Regression, person: JointMeasurements, bmi: float, age: float | None
) -> BodyFat:
    unknown = [name for name in regression.inputs if name not in person.names]
    if unknown:
        return BodyFat(regression, None, None, (f"The fit withholds {', '.join(unknown)}.",))
    chosen = person.of(regression.inputs)

    def percent(values: Values) -> float:
        return regression.percent(values, age or 0.0)

    withheld = _objections(regression, percent(chosen.values), bmi, age)
    if withheld:
        return BodyFat(regression, None, None, withheld)
    slopes = np.array(
        [
            (percent(chosen.values + step) - percent(chosen.values - step)) / (2.0 * _STEP)
            for step in _STEP * np.eye(len(chosen.values))
        ]
    )
    variance = regression.error**2 + slopes @ chosen.covariance @ slopes
    return BodyFat(regression, percent(chosen.values), float(np.sqrt(variance)), ())


def _objections(
    regression: Regression, percent: float, bmi: float, age: float | None
) -> tuple[str, ...]:
    said: list[str] = []
    (youngest, oldest), (thinnest, heaviest) = regression.ages, regression.bmis
    if age is None and regression.needs_age:
        said.append("The regression needs an age, and none was given.")
    if age is not None and not youngest <= age <= oldest:
        said.append(
            f"It was learned from people of {youngest:g} to {oldest:g} years, not of {age:g}."
        )
    if not thinnest <= bmi <= heaviest:
        said.append(
            f"It applies to body mass indices from {thinnest:g} to {heaviest:g}, not to {bmi:.1f}."
        )
    if not said and not 0.0 < percent < 100.0:
        said.append("It gives no share between 0 and 100 % for these girths.")
    return tuple(said)


def _bmi(values: Values) -> float:
    weight, stature = values
    return float(1e4 * weight / stature**2)


def _men_of_the_navy(values: Values, _age: float) -> float:
    waist, neck, height = values
    density = 1.0324 - 0.19077 * _log(waist - neck) + 0.15456 * _log(height)
    return 495.0 / density - 450.0


def _women_of_the_navy(values: Values, _age: float) -> float:
    waist, hips, neck, height = values
    density = 1.29579 - 0.35004 * _log(waist + hips - neck) + 0.22100 * _log(height)
    return 495.0 / density - 450.0


def _log(length: float) -> float:
    """To base 10; of nobody's girths none."""
    return float(np.log10(length)) if length > 0.0 else float("nan")


def _cun_bae(values: Values, age: float, woman: float) -> float:
    bmi = _bmi(values)
    of_sex = woman * (10.689 + 0.181 * bmi - 0.005 * bmi**2)
    of_age = age * (0.503 - 0.02 * bmi + 0.00021 * bmi**2)
    return -44.988 + 3.172 * bmi - 0.026 * bmi**2 + of_sex + of_age


def regressions(gender: Gender) -> tuple[Regression, ...]:
    """All regressions for a gender, the one that needs least first."""
    is_man = gender is Gender.MALE
    girths = ("waist_girth_navel",) if is_man else ("waist_girth_smallest", "hip_girth")
    navy = Regression(
        name="us_navy",
        source=f"Hodgdon and Beckett 1984, NHRC report {'84-11' if is_man else '84-29'}",
        population="Serving sailors of the US Navy, weighed under water.",
        inputs=(*girths, "neck_girth", STATURE),
        percent=_men_of_the_navy if is_man else _women_of_the_navy,
        error=3.52 if is_man else 3.72,
        ages=(18.0, 60.0),
        bmis=(18.5, 35.0),
        needs_age=False,
    )
    cun_bae = Regression(
        name="cun_bae",
        source="Gómez-Ambrosi et al. 2012, Diabetes Care 35:383-388 (CUN-BAE)",
        population="6,510 white adults of 18 to 80 years, measured by air displacement.",
        inputs=(WEIGHT, STATURE),
        percent=lambda values, age: _cun_bae(values, age, 0.0 if is_man else 1.0),
        error=4.66,
        ages=(18.0, 80.0),
        bmis=(18.5, 45.0),
        needs_age=True,
    )
    return navy, cun_bae
