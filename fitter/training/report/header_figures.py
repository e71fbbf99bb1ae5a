"""The figures a build measures and the model's header keeps."""

import numpy as np
from jaxtyping import Float

from fitter.body.model import BodyModel
from fitter.body.scape import ScapeEvaluator
from fitter.body.shape_space import height_of_shape, standing_vertices
from fitter.measurement.definition_file import load_definitions
from fitter.measurement.definitions import Mass
from fitter.measurement.unexplained import UNEXPLAINED_KEY
from fitter.numerics.meshes import enclosed_volume
from fitter.training.articulation.registered_bodies import RegisteredBodies
from fitter.training.assemble import TrainedModel
from fitter.training.report.body_regions import vertex_regions
from fitter.training.report.comparison_figures import HEADER_KEY, comparison_figures
from fitter.training.report.evaluation import mean_areas, shape_residuals
from fitter.training.report.held_out_errors import HeldOutErrors, header_entry
from fitter.training.report.measured_people import measured_bodies
from fitter.training.report.provenance import model_statistics
from fitter.training.report.shape_curve import error_by_count, error_by_metric
from fitter.training.shapes.height_rotation import SOLVED_AT_DEVIATIONS, attribute_changes


def header_figures(
    trained: TrainedModel,
    taught: RegisteredBodies,
    held_out: RegisteredBodies,
    errors: HeldOutErrors,
) -> dict[str, object]:
    """Everything measured on a trained model, its training and its held-out subjects."""
    model = trained.model
    regions = vertex_regions(model)
    return model_statistics(trained) | {
        "model_figures": model_figures(model),
        "held_out_errors": header_entry(errors),
        "shape_error_by_count": error_by_count(
            taught.rest, held_out.rest, model.triangles, taught.measurements
        ),
        "shape_error_by_metric": error_by_metric(
            taught.rest, held_out.rest, model.triangles, regions, taught.measurements
        ),
        HEADER_KEY: comparison_figures(trained, held_out.rest),
        UNEXPLAINED_KEY: unexplained_measurements(model, held_out.rest),
    }


def unexplained_measurements(
    model: BodyModel, rest: Float[np.ndarray, "s m 3"]
) -> dict[str, float]:
    """Root mean square by which held-out bodies measure other than when rebuilt from n."""
    true = measured_bodies(model, rest)
    rebuilt = measured_bodies(model, rest - shape_residuals(model, rest))
    spread = np.sqrt(np.mean((rebuilt - true) ** 2, axis=0))
    return {
        definition.about.name: round(float(value), 4)
        for definition, value in zip(load_definitions(), spread, strict=True)
    }


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
