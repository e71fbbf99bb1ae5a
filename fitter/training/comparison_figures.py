"""Height leak of the earlier methods on a trained model, for its header and report."""

import numpy as np
from jaxtyping import Float

from fitter.body.model import BodyModel
from fitter.body.shape_space import rest_vertices
from fitter.numerics.meshes import enclosed_volume
from fitter.training.assemble import TrainedModel, height_attribute
from fitter.training.attribute_comparisons import allen_leak, allen_map, blanz_vetter_leak
from fitter.training.evaluation import shape_coefficients, vertex_error
from fitter.training.surface import vertex_areas


def comparison_figures(
    trained: TrainedModel, held_out_rest: Float[np.ndarray, "s m 3"]
) -> dict[str, float]:
    """Figures of Blanz and Vetter's axes and of Allen's map from height and volume, millimetres.

    Allen's map keeps height well where height is linear in the shape; what it gives up is shape:
    ``allen_shape_mm`` is the error of held-out bodies rebuilt from their two attributes.
    """
    model = trained.model
    height = height_attribute(model)
    attributes = _attributes(model, trained.coefficients)
    areas = vertex_areas(model.mean_vertices, model.triangles)
    gram = np.einsum("amc,m,bmc->ab", model.shape_basis, areas, model.shape_basis, optimize=True)
    mapped = allen_map(trained.coefficients, attributes)
    held_out = _attributes(model, shape_coefficients(model, held_out_rest))
    rebuilt = np.stack([rest_vertices(model, shape) for shape in mapped.shapes(held_out)])
    return {
        "blanz_vetter_height_change_mm": 1000.0
        * blanz_vetter_leak(height, trained.coefficients, attributes[:, 0], gram),
        "allen_height_change_mm": 1000.0 * allen_leak(height, mapped, attributes, kept=0),
        "allen_shape_mm": vertex_error(held_out_rest - rebuilt, areas).by_vertex,
    }


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
