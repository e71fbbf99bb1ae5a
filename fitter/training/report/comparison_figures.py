"""Height leak of the two earlier methods of section 4 on a trained model: header and report."""

from collections.abc import Mapping

import numpy as np
from jaxtyping import Float

from fitter.body.model import BodyModel
from fitter.body.shape_space import rest_vertices
from fitter.numerics.meshes import enclosed_volume
from fitter.training.assemble import TrainedModel, height_attribute
from fitter.training.report.evaluation import mean_areas, shape_coefficients, vertex_error
from fitter.training.report.reported import Reported
from fitter.training.report.text_tables import note_lines, table_lines
from fitter.training.shapes.attribute_comparisons import allen_leak, allen_map, blanz_vetter_leak
from fitter.training.shapes.attribute_spaces import gram_of_axes

HEADER_KEY = "height_in_earlier_methods"


def comparison_figures(
    trained: TrainedModel, held_out_rest: Float[np.ndarray, "s m 3"]
) -> dict[str, float]:
    """Figures of Blanz and Vetter's axes and of Allen's map from height and volume, millimetres.

    What is orthogonal to an axis is a matter of metric: that of the mesh, as in unwhitened
    coefficients, or that of whitened ones, where the axis is the gradient of any attribute that is
    linear in the shape. Allen's map keeps height where height is linear in the shape; what it gives
    up is shape: ``allen_shape_mm`` is the error of held-out bodies rebuilt from two attributes.
    """
    model = trained.model
    height = height_attribute(model)
    attributes = _attributes(model, trained.coefficients)
    mapped = allen_map(trained.coefficients, attributes)
    held_out = _attributes(model, shape_coefficients(model, held_out_rest))
    rebuilt = np.stack([rest_vertices(model, shape) for shape in mapped.shapes(held_out)])
    as_shapes, as_coefficients = (
        blanz_vetter_leak(height, trained.coefficients, attributes[:, 0], gram)
        for gram in (gram_of_axes(model), np.eye(len(model.shape_basis)))
    )
    return {
        "blanz_vetter_height_change_mm": 1000.0 * as_shapes,
        "blanz_vetter_whitened_height_change_mm": 1000.0 * as_coefficients,
        "allen_height_change_mm": 1000.0 * allen_leak(height, mapped, attributes, kept=0),
        "allen_shape_mm": vertex_error(held_out_rest - rebuilt, mean_areas(model)).by_vertex,
    }


def comparison_lines(reported: Reported) -> tuple[str, ...]:
    """The table, from the header: the training subjects are needed to make it."""
    figures = reported.model.header.get(HEADER_KEY)
    if not isinstance(figures, Mapping):
        return ()
    names = {
        "blanz_vetter_height_change_mm": "Blanz and Vetter, axes orthogonal as shapes",
        "blanz_vetter_whitened_height_change_mm": "  the same, orthogonal in whitened coefficients",
        "allen_height_change_mm": "Allen et al., height held and volume moved",
    }
    rows = [(name, f"{figures[key]:.3f} mm") for key, name in names.items() if key in figures]
    rows.append(("this rotation", f"{reported.errors.height_change_at_3_deviations:.3f} mm"))
    return (
        *table_lines("height change at 3 sd where height should keep (section 4)", ("", ""), rows),
        *note_lines(
            "Directions that are orthogonal, as shapes, to Blanz and Vetter's axis do not keep "
            "height, as the paper says. Orthogonal in coefficients whitened on the same bodies "
            "they do: height is linear in the shape, and its covariance with white coefficients is "
            "its gradient. Allen's linear map keeps height too, but leaves only the attributes to "
            "vary: held-out bodies rebuilt from height "
            f"and volume are {figures['allen_shape_mm']:.1f} mm off, from "
            f"{len(reported.model.shape_basis)} coefficients {reported.errors.shape.by_vertex:.1f}."
        ),
    )


def _attributes(
    model: BodyModel, coefficients: Float[np.ndarray, "s n"]
) -> Float[np.ndarray, "s 2"]:
    """Height and volume of bodies."""
    height = height_attribute(model)
    return np.array(
        [
            [height(shape), enclosed_volume(rest_vertices(model, shape), model.triangles)]
            for shape in coefficients
        ]
    )
