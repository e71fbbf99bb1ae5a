"""The report on a trained model: its sections, in order."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np

from fitter.body.model import BodyModel
from fitter.measurement.definitions import load_definitions
from fitter.training.report.header_figures import EARLIER_METHODS_KEY
from fitter.training.report.survey_comparison import (
    comparison_lines,
    drawn_measurements,
    survey_comparison,
    table_lines,
)

AGREED = 1e-3
"""Tolerance of every held-out figure: micrometres, and thousandths of a correlation. Single
precision is finer."""

GOALS_MM: Mapping[str, float] = {
    "shape_mm": 3.0,
    "height_change_at_3_deviations_mm": 1.0,
    "posed_mm": 4.5,
}
"""Limits that a model of twenty axes must not exceed on held-out subjects."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Reported:
    """A trained model as its file has it, its figures on bodies it has not seen, and its size."""

    model: BodyModel
    held_out: dict[str, float | int]
    file_bytes: int


def report_lines(reported: Reported) -> Iterator[str]:
    """The report line by line, every section as soon as it is made."""
    yield from summary_lines(reported)
    yield from header_lines(reported.model)
    yield from survey_lines(reported.model)


def summary_lines(reported: Reported) -> tuple[str, ...]:
    """Size, held-out figures with their goals, and whether they are those of the build."""
    model, found = reported.model, reported.held_out
    header = model.header
    mesh = f"{len(model.mean_vertices)} vertices, {len(model.triangles)} triangles"
    size = f"{mesh}, {len(model.shape_basis)} shape axes, {reported.file_bytes / 1e6:.1f} MB"
    subjects = f"{header.get('training_subjects')} subjects, held out {found['subjects']}"
    rows = [
        (name, f"{value:.4f}", *_verdict(value, GOALS_MM.get(name)))
        for name, value in found.items()
        if name != "subjects"
    ]
    differing = disagreements(reported)
    agreement = "the same" if not differing else f"DIFFERENT: {', '.join(differing)}"
    return (
        f"{model.gender}: {size}",
        f"  trained on {subjects}, seed {header['seed']}",
        *table_lines("on held-out subjects", ("", "found", "goal", ""), rows),
        f"  the header's held-out figures, made again: {agreement}",
    )


def disagreements(reported: Reported) -> tuple[str, ...]:
    """Names of figures that the header does not have so: it was built from other subjects."""
    kept = reported.model.header.get("held_out_errors")
    claimed = dict(kept) if isinstance(kept, Mapping) else {}
    found = reported.held_out
    return tuple(
        name
        for name in found | claimed
        # Written so that what is not a number differs.
        if not abs(float(claimed.get(name, np.nan)) - found.get(name, np.nan)) <= AGREED
    )


def header_lines(model: BodyModel) -> tuple[str, ...]:
    """Figures that only training subjects can tell, from the header, where the build put them."""
    residuals, earlier = (
        found if isinstance(found := model.header.get(key), Mapping) else {}
        for key in ("population_residuals", EARLIER_METHODS_KEY)
    )
    return (
        *table_lines(
            "population: mean absolute distance of a subject from its measurements",
            ("", ""),
            [(str(name), str(value)) for name, value in residuals.items()],
        ),
        *table_lines(
            "height change at 3 sd on Blanz and Vetter's axes (section 4)",
            ("", ""),
            [
                (name, f"{earlier[key]:.3f} mm")
                for key, name in (
                    ("blanz_vetter_height_change_mm", "orthogonal as shapes"),
                    ("blanz_vetter_whitened_height_change_mm", "in whitened coefficients"),
                )
                if key in earlier
            ],
        ),
    )


def survey_lines(model: BodyModel) -> tuple[str, ...]:
    """The model's people beside the survey's."""
    people = drawn_measurements(model)
    return comparison_lines(survey_comparison(model.gender, load_definitions(), people))


def _verdict(value: float, limit: float | None) -> tuple[str, str]:
    if limit is None:
        return "", ""
    return f"<= {limit:g}", "ok" if value <= limit else "MISSED"
