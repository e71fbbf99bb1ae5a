"""Size and build of the model's people beside the civilians that training draws from.

What NHANES publishes of a body and we measure is stature, weight and a waist. Its civilians are
taken with ages drawn evenly, as the training's are.
"""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from fitter.measurement.definition_file import load_definitions
from fitter.training.report.measured_people import drawn_people, held_out_people
from fitter.training.report.reported import Reported
from fitter.training.report.text_tables import note_lines, table_lines
from fitter.training.surveys.civilians import (
    CivilianStatistics,
    draw_civilian,
    load_civilians,
    packaged_civilians_path,
)

CIVILIANS = 20_000
"""Drawn to know the survey's figures: their means to a 140th of a standard deviation."""

TALLIED = ("stature", "weight", "waist_girth_navel")
"""Measurements, centimetres and kilograms."""

CENTIMETRES_PER_METRE = 100.0
_SEED = 20172018


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class CivilianFigures:
    """Of people of one gender.

    Attributes
    ----------
    mean, deviation
        (3,) of stature (cm), weight (kg) and body mass index (kg/m²).
    correlation
        Of stature with weight.
    waist_cm
        Geometric mean: the survey's is kept as a mean of logarithms, without its spread.
    """

    mean: Float[np.ndarray, "3"]
    deviation: Float[np.ndarray, "3"]
    correlation: float
    waist_cm: float


def figures_of_people(values: Float[np.ndarray, "s 3"]) -> CivilianFigures:
    """Of s people's :data:`TALLIED`."""
    stature, weight, waist = values.T
    index = weight / (stature / CENTIMETRES_PER_METRE) ** 2
    columns = np.stack([stature, weight, index])
    return CivilianFigures(
        mean=columns.mean(axis=1),
        deviation=columns.std(axis=1),
        correlation=float(np.corrcoef(stature, weight)[0, 1]),
        waist_cm=float(np.exp(np.log(waist).mean())),
    )


def figures_of_civilians(
    statistics: CivilianStatistics, rng: np.random.Generator, count: int = CIVILIANS
) -> CivilianFigures:
    """Of the survey's civilians, ages even and body mass index within the training's range."""
    drawn = [draw_civilian(statistics, rng) for _ in range(count)]
    ages = [one.age for one in drawn]
    waists = CENTIMETRES_PER_METRE * np.exp(np.interp(ages, statistics.age, statistics.log_waist))
    rows = [
        (CENTIMETRES_PER_METRE * one.stature, one.weight, waist)
        for one, waist in zip(drawn, waists, strict=True)
    ]
    return figures_of_people(np.array(rows))


def civilian_lines(reported: Reported) -> tuple[str, ...]:
    """The section of the report."""
    names = [definition.about.name for definition in load_definitions()]
    chosen = [names.index(name) for name in TALLIED]
    statistics = load_civilians(packaged_civilians_path(), reported.model.gender)
    columns = (
        figures_of_civilians(statistics, np.random.default_rng(_SEED)),
        figures_of_people(held_out_people(reported)[:, chosen]),
        figures_of_people(drawn_people(reported)[:, chosen]),
    )
    rows = [
        (what, unit, *(f"{each.mean[k]:.1f} ({each.deviation[k]:.1f})" for each in columns))
        for k, (what, unit) in enumerate(
            (("stature", "cm"), ("weight", "kg"), ("body mass index", "kg/m2"))
        )
    ]
    rows.append(("stature with weight", "", *(f"{each.correlation:.2f}" for each in columns)))
    rows.append(("waist, geometric mean", "cm", *(f"{each.waist_cm:.1f}" for each in columns)))
    return (
        *table_lines(
            "people beside NHANES's civilians, ages even: mean (sd), correlation",
            ("", "unit", "NHANES", "held out", "model"),
            rows,
        ),
        *note_lines(
            "NHANES measures the waist above the iliac crest, we at the navel. Model: people drawn "
            "from N(0, I), symmetric where the survey's weights lean to the heavy."
        ),
    )
