"""Held-out error of shape spaces of other sizes, and learned in other metrics (section 3).

These need the training subjects, so the build measures them and the model's header keeps them.
"""

from collections.abc import Mapping

import numpy as np
from jaxtyping import Bool, Float

from fitter.arrays import PerVertex, Triangles
from fitter.training.report.evaluation import vertex_error
from fitter.training.shapes.principal_shapes import centred, principal_shapes, project
from fitter.training.shapes.surface import vertex_areas, vertex_masses

COUNTS = (5, 10, 20, 40, 80)
COMPARED_COUNT = 20
"""n at which metrics are compared."""


def error_by_count(
    training: Float[np.ndarray, "s m 3"],
    held_out: Float[np.ndarray, "r m 3"],
    triangles: Triangles,
    measurements: Float[np.ndarray, "s k"] | None = None,
) -> dict[str, dict[str, float]]:
    """Mean error of held-out bodies rebuilt from n coefficients, millimetres, by n.

    ``measurements`` count in training as they do for the model. Counts beyond what the training
    subjects can span are left out.
    """
    mean = training.mean(axis=0, dtype=np.float64)
    masses, areas = vertex_masses(mean, triangles), vertex_areas(mean, triangles)
    counts = [count for count in COUNTS if count < len(training)]
    shapes = principal_shapes(training, masses, counts[-1], measurements)
    errors = {}
    for count in counts:
        _, residuals = project(held_out, masses, shapes.mean, shapes.axes[:count])
        error = vertex_error(residuals, areas)
        errors[str(count)] = {"by_vertex": error.by_vertex, "by_area": error.by_area}
    return errors


def error_by_metric(
    training: Float[np.ndarray, "s m 3"],
    held_out: Float[np.ndarray, "r m 3"],
    triangles: Triangles,
    regions: Mapping[str, Bool[np.ndarray, " m"]],
    measurements: Float[np.ndarray, "s k"] | None = None,
) -> dict[str, dict[str, float]]:
    """The same at n = 20 for the metrics by area, by vertex and the model's own, by region.

    ``measurements`` count in the model's own metric.

    Every space is learned and projected onto in its own metric; a region's error counts every
    square centimetre of its skin once, bodies laid mass centre on mass centre.
    """
    mean = training.mean(axis=0, dtype=np.float64)
    areas = vertex_areas(mean, triangles)
    metrics: dict[str, tuple[PerVertex, np.ndarray | None]] = {
        "area": (areas / areas.sum(), None),
        "model": (vertex_masses(mean, triangles), measurements),
        "vertex": (np.full(len(areas), 1.0 / len(areas)), None),
    }
    figures = {}
    for name, (masses, counted) in metrics.items():
        count = min(COMPARED_COUNT, len(training) - 1)
        shapes = principal_shapes(training, masses, count, counted)
        _, residuals = project(held_out, masses, shapes.mean, shapes.axes)
        error = vertex_error(residuals, areas)
        figures[name] = {"by_vertex": error.by_vertex, "by_area": error.by_area}
        figures[name] |= region_errors(residuals, areas, regions)
    return figures


def region_errors(
    residuals: Float[np.ndarray, "s m 3"],
    areas: PerVertex,
    regions: Mapping[str, Bool[np.ndarray, " m"]],
) -> dict[str, float]:
    """Mean length of residuals (metres) in each region by area, millimetres, bodies centred."""
    lengths = 1000.0 * np.linalg.norm(centred(residuals, areas), axis=2).mean(axis=0)
    return {
        name: float(np.average(lengths[members], weights=areas[members]))
        for name, members in regions.items()
        if members.any()
    }
