"""Means, spreads and correlations of the model's measurements beside the survey's.

People are drawn from the model's N(0, I), which is wider than the survey's soldiers on purpose. So
each person is weighted, so that the weighted people have the survey's joint distribution of stature
and weight; what then differs is definition, pose, age and model.
"""

import json
import textwrap
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

import numpy as np
from jaxtyping import Float

from fitter.body.model import BodyModel
from fitter.body.scape import ScapeEvaluator
from fitter.measurement.anthropometry import measurement_values, measuring_body
from fitter.measurement.definitions import MeasurementDefinition
from fitter.training.surveys.survey import load_statistics, packaged_statistics_path

INDENT = "  "
NOTE_WIDTH = 92


def table_lines(
    title: str, columns: Sequence[str], rows: Sequence[Sequence[str]]
) -> tuple[str, ...]:
    """A title, column heads and rows: the first column to the left, the others to the right.

    Parameters
    ----------
    columns
        Heads; the first may be empty.
    rows
        As many cells each as there are heads.
    """
    cells = [list(columns), *(list(row) for row in rows)]
    widths = [max(len(row[column]) for row in cells) for column in range(len(columns))]
    lines = [
        row[0].ljust(widths[0])
        + "".join(f"  {cell.rjust(width)}" for cell, width in zip(row[1:], widths[1:], strict=True))
        for row in cells
    ]
    # Without heads there is no line for them.
    shown = lines if any(columns) else lines[1:]
    return (INDENT + title, *(2 * INDENT + line.rstrip() for line in shown))


def note_lines(text: str) -> tuple[str, ...]:
    """Sentences, wrapped and indented."""
    return tuple(2 * INDENT + line for line in textwrap.wrap(text, NOTE_WIDTH))


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class SurveyMoments:
    """First and second moments of survey fields among one gender; centimetres and kilograms."""

    names: tuple[str, ...]
    count: int
    mean: Float[np.ndarray, " q"]
    covariance: Float[np.ndarray, "q q"]

    def of(
        self, combinations: Sequence[Mapping[str, float]]
    ) -> tuple[Float[np.ndarray, " c"], Float[np.ndarray, "c c"]]:
        """Mean and covariance of weighted sums of fields."""
        rows = np.array(
            [[weights.get(name, 0.0) for name in self.names] for weights in combinations]
        )
        unknown = {name for weights in combinations for name in weights} - set(self.names)
        if unknown:
            message = f"no moments of {', '.join(sorted(unknown))}"
            raise KeyError(message)
        return rows @ self.mean, rows @ self.covariance @ rows.T


def packaged_moments_path() -> Path:
    """The committed moments."""
    return Path(__file__).parents[1] / "surveys" / "data" / "survey_moments.json"


def load_moments(path: Path, gender: str) -> SurveyMoments:
    """Read the moments of ``female`` or ``male``."""
    content = json.loads(path.read_text())[gender]
    return SurveyMoments(
        names=tuple(content["names"]),
        count=int(content["count"]),
        mean=np.array(content["mean"]),
        covariance=np.array(content["covariance"]),
    )


PEOPLE = 1000
GIVEN = ("stature", "weight")
"""Measurements by whose logarithms people are weighted."""

_SEED = 20120101


class Moments(NamedTuple):
    """Mean and covariance of k measurements."""

    mean: Float[np.ndarray, " k"]
    covariance: Float[np.ndarray, "k k"]

    @property
    def deviation(self) -> Float[np.ndarray, " k"]:
        """Standard deviations."""
        return np.sqrt(np.diagonal(self.covariance))

    @property
    def correlation(self) -> Float[np.ndarray, "k k"]:
        """Correlation matrix."""
        return self.covariance / np.outer(self.deviation, self.deviation)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class SurveyComparison:
    """People measured as the service does, beside the survey.

    Attributes
    ----------
    names, units
        Of the k measurements that the survey has too; centimetres and kilograms.
    survey
        Its moments; fields that are summed, and flexed arms, as the definitions say.
    people
        Those of the people, weighted.
    effective_count
        Of equally weighted people that say as much as the weighted ones.
    """

    names: tuple[str, ...]
    units: tuple[str, ...]
    survey: Moments
    people: Moments
    effective_count: float

    @property
    def mean_differences(self) -> Float[np.ndarray, " k"]:
        """The people's means less the survey's, in the survey's standard deviations."""
        return (self.people.mean - self.survey.mean) / self.survey.deviation

    @property
    def correlation_differences(self) -> Float[np.ndarray, "k k"]:
        """The people's correlations less the survey's."""
        return self.people.correlation - self.survey.correlation


def drawn_measurements(
    model: BodyModel, count: int = PEOPLE, seed: int = _SEED
) -> Float[np.ndarray, "s d"]:
    """Every measurement of people drawn from the model, in the definitions' order."""
    body = measuring_body(model, ScapeEvaluator(model))
    shapes = np.random.default_rng(seed).normal(size=(count, len(model.shape_basis)))
    return np.stack([measurement_values(body, shape) for shape in shapes])


def survey_comparison(
    gender: str, definitions: Sequence[MeasurementDefinition], values: Float[np.ndarray, "s d"]
) -> SurveyComparison:
    """The comparison of s people's ``values``, one column a definition, with the survey's."""
    names = [definition.about.name for definition in definitions]
    given = np.log(values[:, [names.index(name) for name in GIVEN]])
    weights = matching_weights(given, _statures_and_weights(gender))
    chosen = [k for k, definition in enumerate(definitions) if definition.about.survey.fields]
    surveys = [definitions[k].about.survey for k in chosen]
    moments = load_moments(packaged_moments_path(), gender)
    return SurveyComparison(
        names=tuple(names[k] for k in chosen),
        units=tuple(definitions[k].about.unit.value for k in chosen),
        survey=Moments(*moments.of([dict.fromkeys(each.fields, each.share) for each in surveys])),
        people=weighted_moments(values[:, chosen], weights),
        effective_count=effective_count(weights),
    )


def comparison_lines(found: SurveyComparison) -> tuple[str, ...]:
    """The tables of the report."""
    stature, weight = (found.names.index(name) for name in GIVEN)
    off, apart = found.mean_differences, np.abs(found.correlation_differences)
    columns = (
        *(found.survey.mean, found.survey.deviation, found.people.mean, found.people.deviation),
        off,
        *(each.correlation[stature] for each in (found.survey, found.people)),
        *(each.correlation[weight] for each in (found.survey, found.people)),
        apart.sum(axis=1) / (len(off) - 1),
    )
    rows = [
        (name, found.units[k], *(f"{column[k]:.2f}" for column in columns))
        for k, name in enumerate(found.names)
    ]
    heads = ("", "unit", "survey", "sd", "model", "sd", "off", "r stature", "model", "r weight")
    pairs = np.triu_indices(len(off), 1)
    return (
        *table_lines("measurements beside ANSUR II's", (*heads, "model", "r off"), rows),
        *note_lines(
            f"{PEOPLE} people drawn from the model, weighted so that stature and weight have the "
            f"survey's means, spreads and correlation (as {found.effective_count:.0f} would that "
            "weigh alike). Off: of the mean, in the survey's standard deviations, "
            f"{np.abs(off).mean():.2f} on average. r: correlation with stature and with weight; r "
            "off: mean absolute difference of the correlations with all others, "
            f"{apart[pairs].mean():.3f} on average. Relaxed arms are compared with 0.93 and 0.96 "
            "of the survey's flexed girths. MEASUREMENTS.md says how definitions differ."
        ),
    )


def matching_weights(given: Float[np.ndarray, "s d"], target: Moments) -> Float[np.ndarray, " s"]:
    """Weights, summing to one, under which ``given`` have the target's mean and covariance.

    The quotient of two Gaussian densities, the target's and their own: exact for Gaussian people.
    """
    own = Moments(mean=given.mean(axis=0), covariance=np.cov(given.T, bias=True))
    exponents = 0.5 * (_squared_distances(given, own) - _squared_distances(given, target))
    weights = np.exp(exponents - exponents.max())
    return weights / weights.sum()


def effective_count(weights: Float[np.ndarray, " s"]) -> float:
    """Number of equally weighted people that say as much: (Σ w)² / Σ w²."""
    return float(weights.sum() ** 2 / (weights @ weights))


def weighted_moments(values: Float[np.ndarray, "s k"], weights: Float[np.ndarray, " s"]) -> Moments:
    """Mean and covariance under weights that sum to one."""
    mean = weights @ values
    offsets = values - mean
    return Moments(mean=mean, covariance=(offsets * weights[:, None]).T @ offsets)


def _squared_distances(points: Float[np.ndarray, "s d"], of: Moments) -> Float[np.ndarray, " s"]:
    """Mahalanobis distances, squared."""
    offsets = points - of.mean
    return np.einsum("si,ij,sj->s", offsets, np.linalg.inv(of.covariance), offsets)


def _statures_and_weights(gender: str) -> Moments:
    """The survey's moments of their logarithms, centimetres and kilograms."""
    statistics = load_statistics(packaged_statistics_path(), gender)
    rows = [statistics.names.index(name) for name in ("stature", "weightkg")]
    return Moments(
        mean=statistics.log_mean[rows] + [np.log(100.0), 0.0],
        covariance=statistics.log_covariance[np.ix_(rows, rows)],
    )
