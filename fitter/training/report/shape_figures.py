"""What twenty coefficients keep of bodies the model has not seen: by region and by measurement."""

from collections.abc import Mapping

import numpy as np
from jaxtyping import Float

from fitter.body.model import BodyModel
from fitter.measurement.definition_file import load_definitions
from fitter.training.report.body_regions import vertex_regions
from fitter.training.report.evaluation import mean_areas, shape_residuals
from fitter.training.report.measured_people import held_out_people, measured_bodies
from fitter.training.report.reported import Reported
from fitter.training.report.shape_curve import region_errors
from fitter.training.report.text_tables import note_lines, table_lines


def shape_lines(reported: Reported) -> tuple[str, ...]:
    """Error over n, by region, and of every measurement."""
    model, rest = reported.model, reported.bodies.rest
    residuals = shape_residuals(model, rest)
    return (
        *_count_lines(model),
        *_region_lines(model, residuals),
        *_measurement_lines(reported, residuals),
    )


def _count_lines(model: BodyModel) -> tuple[str, ...]:
    curve = model.header.get("shape_error_by_count")
    if not isinstance(curve, Mapping):
        return ()
    rows = [
        (f"n = {count}", f"{error['by_vertex']:.2f}", f"{error['by_area']:.2f}")
        for count, error in sorted(curve.items(), key=lambda item: int(item[0]))
    ]
    return table_lines(
        "held-out error by number of coefficients, mm", ("", "by vertex", "by area"), rows
    )


def _region_lines(model: BodyModel, residuals: Float[np.ndarray, "s m 3"]) -> tuple[str, ...]:
    areas, regions = mean_areas(model), vertex_regions(model)
    errors = region_errors(residuals, areas, regions)
    rows = [
        (
            name,
            f"{error:.2f}",
            f"{100.0 * areas[regions[name]].sum() / areas.sum():.0f} %",
            f"{100.0 * regions[name].mean():.0f} %",
        )
        for name, error in errors.items()
    ]
    return table_lines(
        "the same by region, mm, each region's skin weighed by area",
        ("", "error", "of the area", "of the vertices"),
        rows,
    )


def _measurement_lines(
    reported: Reported, residuals: Float[np.ndarray, "s m 3"]
) -> tuple[str, ...]:
    true = held_out_people(reported)
    errors = measured_bodies(reported.model, reported.bodies.rest - residuals) - true
    rows = [
        (
            definition.about.name,
            definition.about.unit.value,
            f"{true[:, k].std():.2f}",
            f"{errors[:, k].mean():+.2f}",
            f"{np.abs(errors[:, k]).mean():.2f}",
            f"{np.abs(errors[:, k]).max():.2f}",
        )
        for k, definition in enumerate(load_definitions())
    ]
    heads = ("", "unit", "sd of people", "mean error", "mean abs", "worst")
    return (
        *table_lines("held-out bodies rebuilt from n coefficients, measured", heads, rows),
        *note_lines(
            "What the shape space cannot express; a fit to a picture adds its own error to this."
        ),
    )
