"""The statistics of ANSUR II, and all measurements of a civilian drawn from them.

ANSUR II is the anthropometric survey of the US Army of 2012 (public release; Gordon et al. 2014):
4,082 men and 1,986 women. Means and covariances of the logarithms of its measurements, and of age,
are kept in ``data/survey_statistics.json``, so that training needs no other file; logarithms keep
draws positive and give girths and weight the long upper tail they have. Its girths of biceps and
forearm are the survey's of the flexed arm times :data:`RELAXED_SHARE`.

Soldiers are young and fit. Age, stature and weight of a subject are therefore a civilian's, by the
National Health and Nutrition Examination Survey (NHANES 2017-2018, US Centers for Disease Control
and Prevention, public domain): 2,647 women and 2,528 men from 18 to 80 and older. Its statistics by
age are kept in ``data/civilian_statistics.json``: unweighted counts of people from 18 up, 25, 35,
45, 55, 65 and 75 years, which hold more old people and more ancestries than the country does. All
other measurements follow those three as they do
among the surveyed: by the survey's regression, with its residual covariance. Carried on to civilian
ages and weights, that regression predicts the one girth both surveys took: mean waists of all
civilian age groups within 3 %, with the same spread about it.
"""

import json
from collections.abc import Mapping, Sequence
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


TAPE_OVER_CALIPER: Mapping[str, Mapping[str, float]] = {
    "female": {
        "waistbreadth": 1.015,
        "waistdepth": 1.065,
        **dict.fromkeys(("hipbreadth", "buttockdepth"), 1.058),
        **dict.fromkeys(("headbreadth", "headlength"), 1.033),
    },
    "male": {
        "waistbreadth": 1.029,
        "waistdepth": 1.05,
        **dict.fromkeys(("hipbreadth", "buttockdepth"), 1.040),
        **dict.fromkeys(("headbreadth", "headlength"), 1.007),
    },
}
"""The survey's tape and calipers contradict each other: the ellipse with its mean breadth and depth
has a circumference 5 to 10 % below its mean tape at waist and hips, where a section of the body
model exceeds its ellipse by 3 to 5 %. Calipers press the flesh, and a woman's head is measured over
her hair by the tape alone. Breadth and depth are enlarged so that the circumference can hold: at
hips and head both by the quotient of the two ratios, at the waist depth more than breadth: there
the calipers press the belly (enlarged alike, breadth and depth missed by -7 and +9 mm in women, -1
and +5 mm in men). Fitted as they stand, tape and calipers would meet half way, with 13 to 22 mm
missing at waist and hips (means of ten subjects a gender)."""

RELAXED_SHARE = {"bicepscircumference": 0.93, "forearmcircumference": 0.96}
"""Girth of the relaxed over that of the flexed arm, which the survey measures: an assumption."""

REST_POSE_RISE_M: Mapping[str, Mapping[str, float]] = {
    "female": {"acromialheight": 0.010},
    "male": {"acromialheight": 0.034, "suprasternaleheight": -0.004},
}
"""The model's rest pose raises the arms, and the tips of the shoulders with them. Mean residuals of
a fit that left these heights loose."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class SurveyStatistics:
    """Mean and covariance of the natural logarithms of measurements in metres and kilograms.

    ``age_mean`` and ``age_variance`` are of age in years; ``age_covariance`` (q,) is between age
    and the logarithms.
    """

    names: tuple[str, ...]
    count: int
    log_mean: Float[np.ndarray, " q"]
    log_covariance: Float[np.ndarray, "q q"]
    age_mean: float
    age_variance: float
    age_covariance: Float[np.ndarray, " q"]

    @property
    def median(self) -> Float[np.ndarray, " q"]:
        """Median, metres and kilograms."""
        return np.exp(self.log_mean)

    @property
    def deviation(self) -> Float[np.ndarray, " q"]:
        """Standard deviation, metres and kilograms, to first order."""
        return self.median * np.sqrt(np.diagonal(self.log_covariance))


def packaged_statistics_path() -> Path:
    """The committed statistics."""
    return Path(__file__).parent / "data" / "survey_statistics.json"


def on_the_model(
    names: Sequence[str], gender: str, surveyed: Float[np.ndarray, "... q"]
) -> Float[np.ndarray, "... q"]:
    """Measurements of a body model of a surveyed person, where its definitions differ."""
    scale = np.array([TAPE_OVER_CALIPER[gender].get(name, 1.0) for name in names])
    rise = np.array([REST_POSE_RISE_M[gender].get(name, 0.0) for name in names])
    return surveyed * scale + rise


def load_statistics(path: Path, gender: str) -> SurveyStatistics:
    """Read the statistics of ``female`` or ``male``."""
    content = json.loads(path.read_text())[gender]
    return SurveyStatistics(
        names=tuple(content["names"]),
        count=int(content["count"]),
        log_mean=np.array(content["log_mean"]),
        log_covariance=np.array(content["log_covariance"]),
        age_mean=float(content["age_mean"]),
        age_variance=float(content["age_variance"]),
        age_covariance=np.array(content["age_covariance"]),
    )


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Regression:
    """Logarithms of all measurements given stature, weight and age.

    ``log_mean + slope.T @ (given - given_mean)`` with covariance ``residual_covariance``; given are
    log stature, log weight and years. Stature and weight come out as they went in.
    """

    given_mean: Float[np.ndarray, "3"]
    log_mean: Float[np.ndarray, " q"]
    slope: Float[np.ndarray, "3 q"]
    residual_covariance: Float[np.ndarray, "q q"]

    def expected(self, civilian: Civilian) -> Float[np.ndarray, " q"]:
        """Mean logarithms for a person."""
        given = np.array([np.log(civilian.stature), np.log(civilian.weight), civilian.age])
        return self.log_mean + (given - self.given_mean) @ self.slope


def regression(statistics: SurveyStatistics) -> Regression:
    """With a = (log stature, log weight, age): slope Σ_aa⁻¹ Σ_ao, residual Σ_oo - Σ_oa slope."""
    mean, covariance = statistics.log_mean, statistics.log_covariance
    given = [statistics.names.index(name) for name in ("stature", "weightkg")]
    among = np.empty((3, 3))
    among[:2, :2] = covariance[np.ix_(given, given)]
    among[2, :2] = among[:2, 2] = statistics.age_covariance[given]
    among[2, 2] = statistics.age_variance
    across = np.vstack([covariance[given], statistics.age_covariance])
    slope = np.linalg.solve(among, across)
    return Regression(
        given_mean=np.array([*mean[given], statistics.age_mean]),
        log_mean=mean,
        slope=slope,
        residual_covariance=covariance - across.T @ slope,
    )


def draw_measurements(
    statistics: SurveyStatistics, civilian: Civilian, generator: np.random.Generator
) -> Float[np.ndarray, " q"]:
    """Measurements of a subject of a civilian's stature, weight and age, metres and kilograms."""
    found = regression(statistics)
    others = [k for k, name in enumerate(statistics.names) if name not in ("stature", "weightkg")]
    drawn = found.expected(civilian)
    drawn[others] += generator.multivariate_normal(
        np.zeros(len(others)), found.residual_covariance[np.ix_(others, others)], method="cholesky"
    )
    return np.exp(drawn)
