"""The figures a build measures and the model's header keeps."""

import numpy as np
from jaxtyping import Float

from fitter.body.model import BodyModel
from fitter.body.scape import ScapeEvaluator
from fitter.body.shape_space import height_of_shape, rest_vertices, standing_vertices
from fitter.measurement.anthropometry import UNEXPLAINED_KEY, measurement_values, measuring_body
from fitter.measurement.definitions import Mass, load_definitions
from fitter.numerics.meshes import enclosed_volume
from fitter.training.assemble import TrainedModel, height_attribute
from fitter.training.people.subject_fit import DENSITY_KG_PER_M3
from fitter.training.report.held_out_figures import (
    bodies_as_axes,
    height_figures,
    mean_areas,
    shape_residuals,
)
from fitter.training.shapes.attribute_spaces import blanz_vetter_leak, gram_of_axes

EARLIER_METHODS_KEY = "height_in_earlier_methods"

BATCH = 50
"""Bodies measured together; each is an axis of a model and takes 1 MB of it."""


def model_statistics(trained: TrainedModel) -> dict[str, object]:
    """Height and weight in the model's own definitions.

    ``height_m`` is the height of the mean body and its change by one standard deviation of the
    height axis, which is what a height's coefficient is solved from.
    """
    model = trained.model
    height = height_attribute(model)
    axis = np.eye(len(model.shape_basis))[0]
    weights = [
        DENSITY_KG_PER_M3 * enclosed_volume(rest_vertices(model, shape), model.triangles)
        for shape in trained.coefficients
    ]
    return {
        "height_m": {
            "mean": height(0.0 * axis),
            "sd": 0.5 * (height(axis) - height(-axis)),
        },
        "model_weight_kg": {"mean": float(np.mean(weights)), "sd": float(np.std(weights))},
        "part_names": list(model.part_names),
        "landmark_names": list(model.landmarks.names),
    }


def model_figures(model: BodyModel) -> dict[str, float | int]:
    """Counts, the mean body's size, and how well one axis carries height.

    Stature and extent are those of the standing pose; the weight is that of the mean body at rest.
    Every figure repeats to the rounding of the file's single precision.
    """
    evaluator, mean = ScapeEvaluator(model), np.zeros(len(model.shape_basis))
    (density,) = (d.density_kg_per_m3 for d in load_definitions() if isinstance(d, Mass))
    volume = enclosed_volume(model.mean_vertices, model.triangles)
    return {
        "vertices": len(model.mean_vertices),
        "triangles": len(model.triangles),
        "shape_axes": len(model.shape_basis),
        "height_mm": 1000.0 * height_of_shape(evaluator, mean),
        "extent_mm": 1000.0 * float(np.ptp(standing_vertices(evaluator, mean)[:, 1])),
        **height_figures(model),
        "volume_l": 1000.0 * volume,
        "weight_kg": density * volume,
        "surface_m2": float(mean_areas(model).sum()),
    }


def training_figures(
    trained: TrainedModel, held_out_rest: Float[np.ndarray, "s m 3"]
) -> dict[str, object]:
    """Everything measured on a trained model that is no error on held-out subjects."""
    model = trained.model
    return model_statistics(trained) | {
        "model_figures": model_figures(model),
        EARLIER_METHODS_KEY: earlier_methods(trained),
        UNEXPLAINED_KEY: unexplained_measurements(model, held_out_rest),
    }


def earlier_methods(trained: TrainedModel) -> dict[str, float]:
    """Change of height on the axes of Blanz and Vetter, whom section 4 compares itself with.

    What is orthogonal to an axis is a matter of metric: that of the mesh, as in unwhitened
    coefficients, or that of whitened ones, where the axis is the gradient of any attribute that is
    linear in the shape. Millimetres.
    """
    model, coefficients = trained.model, trained.coefficients
    height = height_attribute(model)
    heights = np.array([height(shape) for shape in coefficients])
    as_shapes, as_coefficients = (
        1000.0 * blanz_vetter_leak(height, coefficients, heights, gram)
        for gram in (gram_of_axes(model), np.eye(len(model.shape_basis)))
    )
    return {
        "blanz_vetter_height_change_mm": as_shapes,
        "blanz_vetter_whitened_height_change_mm": as_coefficients,
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


def measured_bodies(model: BodyModel, rest: Float[np.ndarray, "s m 3"]) -> Float[np.ndarray, "s d"]:
    """Every measurement of whole bodies, in the order and units of the definitions.

    The model poses them; their shapes are their own.
    """
    rows = []
    for start in range(0, len(rest), BATCH):
        exact = bodies_as_axes(model, rest[start : start + BATCH])
        body = measuring_body(exact, ScapeEvaluator(exact))
        rows.extend(measurement_values(body, axis) for axis in np.eye(len(exact.shape_basis)))
    return np.stack(rows)
