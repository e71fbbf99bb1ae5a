"""Figures that follow from a model file alone: the header keeps them, a test makes them again."""

import numpy as np

from fitter.body.model import BodyModel
from fitter.body.scape import ScapeEvaluator
from fitter.body.shape_space import height_of_shape, standing_vertices
from fitter.measurement.definition_file import load_definitions
from fitter.measurement.definitions import Mass
from fitter.numerics.meshes import enclosed_volume
from fitter.training.report.evaluation import mean_areas
from fitter.training.shapes.height_rotation import SOLVED_AT_DEVIATIONS, attribute_changes


def model_figures(model: BodyModel) -> dict[str, float | int]:
    """Counts, the mean body's size, and how well one axis carries height.

    Stature and extent are those of the standing pose; the weight is that of the mean body at rest.
    Every figure repeats to the rounding of the file's single precision.
    """
    evaluator = ScapeEvaluator(model)
    axes = np.eye(len(model.shape_basis))
    (density,) = (d.density_kg_per_m3 for d in load_definitions() if isinstance(d, Mass))
    volume = enclosed_volume(model.mean_vertices, model.triangles)

    def height_mm(shape: np.ndarray) -> float:
        return 1000.0 * height_of_shape(evaluator, shape)

    def extent_mm(shape: np.ndarray) -> float:
        return 1000.0 * float(np.ptp(standing_vertices(evaluator, shape)[:, 1]))

    others = list(axes[1:])
    return {
        "vertices": len(model.mean_vertices),
        "triangles": len(model.triangles),
        "shape_axes": len(model.shape_basis),
        "height_mm": height_mm(0.0 * axes[0]),
        "extent_mm": extent_mm(0.0 * axes[0]),
        "height_per_deviation_mm": 0.5 * (height_mm(axes[0]) - height_mm(-axes[0])),
        "height_change_at_3_deviations_mm": float(
            attribute_changes(height_mm, others, SOLVED_AT_DEVIATIONS).max()
        ),
        "extent_change_at_3_deviations_mm": float(
            attribute_changes(extent_mm, others, SOLVED_AT_DEVIATIONS).max()
        ),
        "volume_l": 1000.0 * volume,
        "weight_kg": density * volume,
        "surface_m2": float(mean_areas(model).sum()),
    }
