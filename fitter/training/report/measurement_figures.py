"""Means, spreads and correlations of the service's measurements beside the survey's.

The people measured are the model's own (β drawn from N(0, I)) and held-out bodies. Both are wider
than the survey's soldiers, so besides the plain figures they are weighted to the survey's joint
distribution of stature and weight. They are older too, and the survey itself says by how much that
moves each measurement: what then differs is definition, pose and model.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from fitter.measurement.definition_file import load_definitions
from fitter.measurement.definitions import MeasurementDefinition
from fitter.training.report.measured_people import PEOPLE, drawn_people, held_out_people
from fitter.training.report.reported import Reported
from fitter.training.report.text_tables import note_lines, table_lines
from fitter.training.surveys.age_effect import age_effect
from fitter.training.surveys.civilians import AGES
from fitter.training.surveys.survey import load_statistics, packaged_statistics_path
from fitter.training.surveys.survey_moments import (
    SurveyMoments,
    load_moments,
    packaged_moments_path,
)
from fitter.training.surveys.survey_weights import (
    Target,
    TooFewPeopleError,
    effective_count,
    matching_weights,
    weighted_moments,
)

GIVEN = ("stature", "weight")
"""What people are weighted by, as their logarithms."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Moments:
    """Of k measurements."""

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
class MeasurementFigures:
    """People measured as the service does, beside the survey.

    Attributes
    ----------
    names, units
        Of the k measurements that the survey has too; centimetres and kilograms.
    survey
        Its moments; fields that are summed, and flexed arms, as the definitions say.
    plain, weighted
        The people's, as they are and with the survey's statures and weights.
    effective_count
        Of equally weighted people that say as much as the weighted ones.
    by_age
        (k,) how far people of the training's ages lie from the survey's, of the same stature and
        weight, by the survey: in its standard deviations, not a number where it is not known.
    """

    names: tuple[str, ...]
    units: tuple[str, ...]
    survey: Moments
    plain: Moments
    weighted: Moments
    effective_count: float
    by_age: Float[np.ndarray, " k"]

    @property
    def mean_differences(self) -> Float[np.ndarray, " k"]:
        """Weighted people's means less the survey's, in the survey's standard deviations."""
        return (self.weighted.mean - self.survey.mean) / self.survey.deviation

    @property
    def unexplained(self) -> Float[np.ndarray, " k"]:
        """The same less what goes with age, where that is known."""
        return self.mean_differences - np.nan_to_num(self.by_age)

    @property
    def deviation_quotients(self) -> Float[np.ndarray, " k"]:
        """Weighted people's standard deviations over the survey's."""
        return self.weighted.deviation / self.survey.deviation

    @property
    def correlation_differences(self) -> Float[np.ndarray, "k k"]:
        """Weighted people's correlations less the survey's."""
        return self.weighted.correlation - self.survey.correlation

    @property
    def mean_correlation_difference(self) -> float:
        """Mean absolute difference over all pairs."""
        pairs = np.triu_indices(len(self.names), 1)
        return float(np.abs(self.correlation_differences[pairs]).mean())

    @property
    def chance_correlation_difference(self) -> float:
        """What it would be about if so few people were drawn from the survey itself.

        A correlation r of n people has a standard error of (1 - r²) / √n.
        """
        correlations = self.survey.correlation[np.triu_indices(len(self.names), 1)]
        errors = (1.0 - correlations**2) / np.sqrt(self.effective_count)
        return float(np.sqrt(2.0 / np.pi) * errors.mean())

    @property
    def worst_pair(self) -> tuple[str, str]:
        """The two measurements whose correlation differs most."""
        differences = np.abs(np.triu(self.correlation_differences, 1))
        first, second = np.unravel_index(int(np.argmax(differences)), differences.shape)
        return self.names[first], self.names[second]


def measurement_figures(
    gender: str, definitions: Sequence[MeasurementDefinition], values: Float[np.ndarray, "s d"]
) -> MeasurementFigures:
    """Hold people's measurements against the survey's.

    Parameters
    ----------
    gender
        Of the people.
    definitions, values
        What was measured, and the measurements of s people; the survey has some of them.
    """
    names = [definition.about.name for definition in definitions]
    given = np.log(values[:, [names.index(name) for name in GIVEN]])
    weights = matching_weights(given, _statures_and_weights(gender))
    chosen = [k for k, definition in enumerate(definitions) if definition.about.survey.fields]
    equal = np.full(len(values), 1.0 / len(values))
    survey = load_moments(packaged_moments_path(), gender)
    plain, weighted = (
        Moments(mean=mean, covariance=covariance)
        for mean, covariance in (
            weighted_moments(values[:, chosen], each) for each in (equal, weights)
        )
    )
    return MeasurementFigures(
        names=tuple(names[k] for k in chosen),
        units=tuple(definitions[k].about.unit.value for k in chosen),
        survey=_survey_of(survey, [definitions[k] for k in chosen]),
        plain=plain,
        weighted=weighted,
        effective_count=effective_count(weights),
        by_age=age_effect(gender, [definitions[k] for k in chosen]),
    )


def measurement_lines(reported: Reported) -> tuple[str, ...]:
    """The section of the report."""
    gender, definitions = reported.model.gender, load_definitions()
    try:
        ours = measurement_figures(gender, definitions, drawn_people(reported))
        theirs = measurement_figures(gender, definitions, held_out_people(reported))
    except TooFewPeopleError as error:
        return note_lines(f"Measurements are not held against ANSUR II's: {error}")
    summaries = [_summary(each) for each in (ours, theirs)]
    return (
        *table_lines(
            "measurements as the service takes them, beside ANSUR II's", _HEADS, _rows(ours, theirs)
        ),
        *table_lines(
            "correlations of the same people",
            _CORRELATION_HEADS,
            _correlation_rows(ours, theirs),
        ),
        *table_lines(
            "the same in short",
            ("", "model", "held out"),
            [(head, *(summary[head] for summary in summaries)) for head in summaries[0]],
        ),
        *note_lines(
            f"Model: {PEOPLE} people drawn from N(0, I). As surveyed, and held out: weighted so "
            "that stature and weight have the survey's means, spreads and correlation. Off: of the "
            "mean, in the survey's standard deviations. By age: what the survey's own regression "
            f"foretells of that for people who are {np.mean(AGES):.0f} years old on average, as "
            "ours, and not some 30. Correlations, all: mean absolute difference from the survey's "
            "over the other measurements. Relaxed arms are compared with 0.93 and 0.96 of the "
            "survey's flexed girths. The model's people vary less in what its axes leave out, and "
            "what is left follows the build too closely: girths of neck, head, ankles and wrists. "
            "MEASUREMENTS.md says how definitions differ."
        ),
    )


_HEADS = (
    "",
    "unit",
    *("survey", "sd"),
    *("model", "sd"),
    *("as surveyed", "sd", "off"),
    *("held out", "sd", "off"),
    "by age",
)

_SIGNED = (6, 9, 10)
"""Columns of differences."""

_CORRELATION_HEADS = (
    "",
    *("with stature: survey", "model", "held out"),
    *("with weight: survey", "model", "held out"),
    *("all, mean off: model", "held out"),
)


def _rows(ours: MeasurementFigures, theirs: MeasurementFigures) -> list[tuple[str, ...]]:
    columns = (
        ours.survey.mean,
        ours.survey.deviation,
        ours.plain.mean,
        ours.plain.deviation,
        ours.weighted.mean,
        ours.weighted.deviation,
        ours.mean_differences,
        theirs.weighted.mean,
        theirs.weighted.deviation,
        theirs.mean_differences,
        ours.by_age,
    )
    return [
        (
            name,
            ours.units[k],
            *(
                "" if np.isnan(column[k]) else f"{column[k]:{'+' if place in _SIGNED else ''}.2f}"
                for place, column in enumerate(columns)
            ),
        )
        for k, name in enumerate(ours.names)
    ]


def _correlation_rows(
    ours: MeasurementFigures, theirs: MeasurementFigures
) -> list[tuple[str, ...]]:
    people = (ours.survey, ours.weighted, theirs.weighted)
    given = [ours.names.index(name) for name in GIVEN]
    others = len(ours.names) - 1
    return [
        (
            name,
            *(f"{each.correlation[k, column]:.2f}" for column in given for each in people),
            *(
                f"{np.abs(each.correlation_differences[k]).sum() / others:.2f}"
                for each in (ours, theirs)
            ),
        )
        for k, name in enumerate(ours.names)
    ]


def _summary(figures: MeasurementFigures) -> dict[str, str]:
    differences, quotients = figures.mean_differences, figures.deviation_quotients
    farthest = int(np.argmax(np.abs(differences)))
    unexplained = figures.unexplained
    rest = int(np.argmax(np.abs(unexplained)))
    first, second = (figures.names.index(name) for name in figures.worst_pair)
    pair = [each.correlation[first, second] for each in (figures.weighted, figures.survey)]
    return {
        "people, effectively": f"{figures.effective_count:.0f}",
        "means, mean absolute difference": f"{np.abs(differences).mean():.2f} sd",
        "means, farthest": f"{figures.names[farthest]} {differences[farthest]:+.2f} sd",
        "  less what goes with age": f"{np.abs(unexplained).mean():.2f} sd",
        "  less that, farthest": f"{figures.names[rest]} {unexplained[rest]:+.2f} sd",
        "standard deviations over the survey's": (
            f"{quotients.mean():.2f} ({quotients.min():.2f} to {quotients.max():.2f})"
        ),
        "correlations, mean absolute difference": f"{figures.mean_correlation_difference:.3f}",
        "  by the chance of so few people": f"{figures.chance_correlation_difference:.3f}",
        "correlations, worst pair": " - ".join(figures.worst_pair),
        "  theirs, and the survey's": f"{pair[0]:.2f}, {pair[1]:.2f}",
    }


def _statures_and_weights(gender: str) -> Target:
    """Of their logarithms, centimetres and kilograms."""
    statistics = load_statistics(packaged_statistics_path(), gender)
    rows = [statistics.names.index(name) for name in ("stature", "weightkg")]
    return Target(
        mean=statistics.log_mean[rows] + [np.log(100.0), 0.0],
        covariance=statistics.log_covariance[np.ix_(rows, rows)],
    )


def _survey_of(moments: SurveyMoments, definitions: Sequence[MeasurementDefinition]) -> Moments:
    surveys = [definition.about.survey for definition in definitions]
    mean, covariance = moments.of([dict.fromkeys(each.fields, each.share) for each in surveys])
    return Moments(mean=mean, covariance=covariance)
