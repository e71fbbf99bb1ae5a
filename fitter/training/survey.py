"""The statistics of ANSUR II, and subjects drawn from them.

ANSUR II is the anthropometric survey of the US Army of 2012 (public release; Gordon et al. 2014):
4,082 men and 1,986 women. Means and covariances of the logarithms of its measurements are kept in
``data/survey_statistics.json`` (:mod:`fitter.training.survey_files` makes it), so that training
needs no other file; logarithms keep draws positive and give girths and weight the long upper tail
they have.

Soldiers are young and fit, users are not only soldiers. Drawn subjects therefore take their body
mass index from a wider distribution than the survey's, independent of stature as it is there; all
other measurements follow stature and weight as they do among the surveyed: by the survey's
regression, with its residual covariance.
"""

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from jaxtyping import Float

TAPE_OVER_CALIPER: Mapping[str, Mapping[str, float]] = {
    "female": {
        **dict.fromkeys(("waistbreadth", "waistdepth"), 1.030),
        **dict.fromkeys(("hipbreadth", "buttockdepth"), 1.058),
        **dict.fromkeys(("headbreadth", "headlength"), 1.033),
    },
    "male": {
        **dict.fromkeys(("waistbreadth", "waistdepth"), 1.029),
        **dict.fromkeys(("hipbreadth", "buttockdepth"), 1.040),
        **dict.fromkeys(("headbreadth", "headlength"), 1.007),
    },
}
"""The survey's tape and calipers contradict each other: the ellipse with its mean breadth and depth
has a circumference 5 to 10 % below its mean tape at waist and hips, where a section of the body
model exceeds its ellipse by 3 to 5 %. Calipers press the flesh, and a woman's head is measured over
her hair by the tape alone. Breadth and depth are enlarged alike by the quotient of both ratios,
which keeps the section's proportion and lets the circumference hold. Fitted as they stand, both
would meet half way, with 13 to 22 mm missing at waist and hips (means of ten subjects a gender)."""

REST_POSE_RISE_M: Mapping[str, Mapping[str, float]] = {
    "female": {"acromialheight": 0.010},
    "male": {"acromialheight": 0.034, "suprasternaleheight": -0.004},
}
"""The model's rest pose raises the arms, and the tips of the shoulders with them. Mean residuals of
a fit that left these heights loose."""

CIVILIAN_BMI = {"female": (18.0, 38.0), "male": (18.5, 38.0)}
"""kg/m²: the central 95 % of the body mass index of drawn subjects, log-normal. The survey's own
is 19.4 to 33.5 for women and 20.5 to 36.2 for men; civilian adults reach further on both sides."""

BMI_REACH = 2.5
"""Standard deviations at which draws of the logarithm of the index are held."""

CENTRAL_95_PERCENT = 1.959964


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class SurveyStatistics:
    """Mean and covariance of the natural logarithms of measurements in metres and kilograms."""

    names: tuple[str, ...]
    count: int
    log_mean: Float[np.ndarray, " q"]
    log_covariance: Float[np.ndarray, "q q"]

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
    """What a body model of a surveyed person measures, where its definitions differ."""
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
    )


def draw_subjects(
    statistics: SurveyStatistics, gender: str, count: int, generator: np.random.Generator
) -> Float[np.ndarray, "s q"]:
    """Measurements of ``count`` subjects, metres and kilograms, in the statistics' order.

    With a = (log stature, log weight) drawn as said above and o the other logarithms,
    o | a ~ N(μ_o + Σ_oa Σ_aa⁻¹ (a - μ_a), Σ_oo - Σ_oa Σ_aa⁻¹ Σ_ao).
    """
    mean, covariance = statistics.log_mean, statistics.log_covariance
    stature, weight = (statistics.names.index(name) for name in ("stature", "weightkg"))
    given = [stature, weight]
    others = [k for k in range(len(mean)) if k not in given]
    log_stature = generator.normal(mean[stature], np.sqrt(covariance[stature, stature]), count)
    low, high = np.log(CIVILIAN_BMI[gender])
    spread = 0.5 * (high - low) / CENTRAL_95_PERCENT
    log_bmi = 0.5 * (low + high) + spread * np.clip(
        generator.normal(size=count), -BMI_REACH, BMI_REACH
    )
    drawn = np.empty((count, len(mean)))
    drawn[:, stature] = log_stature
    drawn[:, weight] = log_bmi + 2.0 * log_stature
    slope = np.linalg.solve(covariance[np.ix_(given, given)], covariance[np.ix_(given, others)])
    residual = covariance[np.ix_(others, others)] - covariance[np.ix_(others, given)] @ slope
    centre = mean[others] + (drawn[:, given] - mean[given]) @ slope
    drawn[:, others] = centre + generator.multivariate_normal(
        np.zeros(len(others)), residual, count, method="cholesky"
    )
    return np.exp(drawn)
