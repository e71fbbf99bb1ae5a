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
serving sailors: adults of working age, neither thin nor very heavy. Of overfat sailors Shake et al.
(1993, Military Medicine 158:26-31) found them less certain. The error that is stated is the
regression's own, added in squares to what the errors of the measurements make of it together.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from fitter.measurement.joint_measurements import JointMeasurements
from fitter.measurement.quantity import INTERVAL_SD
from fitter.vocabulary.choices import Gender
from fitter.vocabulary.measurements import STATURE, WEIGHT

CENTIMETRES_PER_METRE = 100.0

Values = Float[np.ndarray, " k"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Range:
    """From ``low`` to ``high``, both included."""

    low: float
    high: float

    def __contains__(self, value: float) -> bool:
        return self.low <= value <= self.high


@dataclass(frozen=True, slots=True, kw_only=True)
class Regression:
    """A published regression as it applies to one gender.

    ``percent`` is given the measurements of ``inputs``, in their order, and the age in years;
    ``slopes`` are its derivatives by them. ``error`` is the standard error of its estimate.
    """

    name: str
    source: str
    population: str
    differences: str
    inputs: tuple[str, ...]
    percent: Callable[[Values, float], float]
    slopes: Callable[[Values, float], Values]
    error: float
    ages: Range
    bmis: Range
    needs_age: bool


@dataclass(frozen=True, slots=True, kw_only=True)
class BodyFat:
    """What one regression says of a person.

    Attributes
    ----------
    name, source, population, differences
        Which regression, where it was published, of whom it was learned, and what is measured
        otherwise here.
    percent
        Fat in percent of the weight; None where the regression does not apply.
    standard_error
        Of it, percent; the squares of the next two add up to its square.
    regression_error, measurement_error
        What the regression errs by, and what the measurements' errors make of it.
    low, high
        95 % interval.
    inputs
        The measurements it is made of.
    withheld
        Why it does not apply; none where it does.
    """

    name: str
    source: str
    population: str
    differences: str
    percent: float | None
    standard_error: float | None
    regression_error: float
    measurement_error: float | None
    low: float | None
    high: float | None
    inputs: tuple[str, ...]
    withheld: tuple[str, ...]


def body_mass_index(person: JointMeasurements) -> tuple[float, float]:
    """Weight over squared height, kg per m², and its standard error."""
    chosen = person.of((WEIGHT, STATURE))
    slopes = _bmi_slopes(chosen.values)
    return _bmi(chosen.values), float(np.sqrt(slopes @ chosen.covariance @ slopes))


def body_fat(
    person: JointMeasurements, gender: Gender, age_years: float | None
) -> tuple[BodyFat, ...]:
    """What every regression says of a person; without an age that of an adult."""
    bmi, _ = body_mass_index(person)
    return tuple(_estimated(each, person, bmi, age_years) for each in regressions(gender))


def regressions(gender: Gender) -> tuple[Regression, ...]:
    """All regressions for a gender, the one that needs least first."""
    return _FOR[gender]


def _estimated(
    regression: Regression, person: JointMeasurements, bmi: float, age: float | None
) -> BodyFat:
    chosen = person.of(regression.inputs)
    withheld = _objections(regression, chosen.values, bmi, age)
    percent = standard_error = measurement_error = low = high = None
    if not withheld:
        years = age or 0.0
        percent = regression.percent(chosen.values, years)
        slopes = regression.slopes(chosen.values, years)
        measurement_error = float(np.sqrt(slopes @ chosen.covariance @ slopes))
        standard_error = float(np.hypot(regression.error, measurement_error))
        low = max(percent - INTERVAL_SD * standard_error, 0.0)
        high = min(percent + INTERVAL_SD * standard_error, 100.0)
    return BodyFat(
        name=regression.name,
        source=regression.source,
        population=regression.population,
        differences=regression.differences,
        percent=percent,
        standard_error=standard_error,
        regression_error=regression.error,
        measurement_error=measurement_error,
        low=low,
        high=high,
        inputs=regression.inputs,
        withheld=withheld,
    )


def _objections(
    regression: Regression, values: Values, bmi: float, age: float | None
) -> tuple[str, ...]:
    said: list[str] = []
    if age is None and regression.needs_age:
        said.append("The regression needs an age, and none was given.")
    if age is not None and age not in regression.ages:
        said.append(
            f"It was learned from people of {regression.ages.low:g} to {regression.ages.high:g} "
            f"years, not of {age:g}."
        )
    if bmi not in regression.bmis:
        said.append(
            f"It applies to body mass indices from {regression.bmis.low:g} to "
            f"{regression.bmis.high:g}, not to {bmi:.1f}."
        )
    if not said and not 0.0 < regression.percent(values, age or 0.0) < 100.0:
        said.append("It gives no share between 0 and 100 % for these girths.")
    return tuple(said)


def _bmi(values: Values) -> float:
    weight, stature = values
    return float(weight / (stature / CENTIMETRES_PER_METRE) ** 2)


def _bmi_slopes(values: Values) -> Values:
    weight, stature = values
    bmi = _bmi(values)
    return np.array([bmi / weight, -2.0 * bmi / stature])


@dataclass(frozen=True, slots=True, kw_only=True)
class _Navy:
    """Constants of one gender; girths are summed with ``signs``, the last input is the height."""

    constant: float
    by_girths: float
    by_height: float
    signs: tuple[float, ...]

    def density(self, values: Values) -> float:
        girths = float(values[:-1] @ np.array(self.signs))
        # Nobody's girths: their logarithm would be none.
        if girths <= 0.0:
            return float("nan")
        return float(
            self.constant
            - self.by_girths * np.log10(girths)
            + self.by_height * np.log10(values[-1])
        )

    def percent(self, values: Values, age: float) -> float:
        del age
        return 495.0 / self.density(values) - 450.0

    def slopes(self, values: Values, age: float) -> Values:
        del age
        signs = np.array(self.signs)
        by_girth = -self.by_girths * signs / float(values[:-1] @ signs)
        by_value = np.append(by_girth, self.by_height / values[-1]) / np.log(10.0)
        return -495.0 / self.density(values) ** 2 * by_value


_NAVY_MEN = _Navy(constant=1.0324, by_girths=0.19077, by_height=0.15456, signs=(1.0, -1.0))
_NAVY_WOMEN = _Navy(constant=1.29579, by_girths=0.35004, by_height=0.22100, signs=(1.0, 1.0, -1.0))


def _cun_bae(bmi: float, age: float, woman: float) -> float:
    return (
        -44.988
        + 0.503 * age
        + 10.689 * woman
        + 3.172 * bmi
        - 0.026 * bmi**2
        + 0.181 * bmi * woman
        - 0.02 * bmi * age
        - 0.005 * bmi**2 * woman
        + 0.00021 * bmi**2 * age
    )


def _cun_bae_slope(bmi: float, age: float, woman: float) -> float:
    """By the body mass index."""
    return (
        3.172 - 0.052 * bmi + 0.181 * woman - 0.02 * age - 0.01 * bmi * woman + 0.00042 * bmi * age
    )


def _navy(equation: _Navy, inputs: Sequence[str], *, report: str, error: float) -> Regression:
    return Regression(
        name="us_navy",
        source="Hodgdon and Beckett 1984, Prediction of percent body fat for U.S. Navy men and "
        f"women, Naval Health Research Center, report {report}",
        population="Serving sailors of the US Navy, weighed under water.",
        differences="The neck is the smallest girth between its base and the jaw, theirs is below "
        "the larynx and never smaller; girths are not rounded, and tapes do not press.",
        inputs=tuple(inputs),
        percent=equation.percent,
        slopes=equation.slopes,
        error=error,
        ages=Range(low=18.0, high=60.0),
        bmis=Range(low=18.5, high=35.0),
        needs_age=False,
    )


def _cun(woman: float) -> Regression:
    return Regression(
        name="cun_bae",
        source="Gómez-Ambrosi et al. 2012, Diabetes Care 35:383-388 (CUN-BAE)",
        population="6,510 white adults of 18 to 80 years, measured by air displacement; on average "
        "they had 39.9 % of fat.",
        differences="A weight that was not given follows from the body's volume.",
        inputs=(WEIGHT, STATURE),
        percent=lambda values, age: _cun_bae(_bmi(values), age, woman),
        slopes=lambda values, age: _cun_bae_slope(_bmi(values), age, woman) * _bmi_slopes(values),
        error=4.66,
        ages=Range(low=18.0, high=80.0),
        bmis=Range(low=18.5, high=45.0),
        needs_age=True,
    )


_FOR: Mapping[Gender, tuple[Regression, ...]] = {
    Gender.MALE: (
        _navy(
            _NAVY_MEN,
            ("waist_girth_navel", "neck_girth", STATURE),
            report="84-11",
            error=3.52,
        ),
        _cun(0.0),
    ),
    Gender.FEMALE: (
        _navy(
            _NAVY_WOMEN,
            ("waist_girth_smallest", "hip_girth", "neck_girth", STATURE),
            report="84-29",
            error=3.72,
        ),
        _cun(1.0),
    ),
}
