"""Attributes that section 4 can give an axis to: stature apart, whatever can be measured."""

import numpy as np

from fitter.arrays import Shape, Vertices
from fitter.body.model import BodyModel
from fitter.body.scape import ScapeEvaluator
from fitter.body.shape_space import rest_vertices
from fitter.body.skeleton import regress
from fitter.errors import DefinitionError
from fitter.measurement.anthropometry import measurement_values, measuring_body
from fitter.measurement.definition_file import load_definitions
from fitter.training.shapes.height_rotation import Attribute
from fitter.training.shapes.surface_paths import SurfacePath, shortest_path


def measurement_attribute(model: BodyModel, name: str) -> Attribute:
    """H(β): a measurement by its name, such as ``weight`` or ``waist_girth_navel``, in its unit.

    Raises
    ------
    DefinitionError
        If there is no measurement of this name.
    """
    chosen = [definition for definition in load_definitions() if definition.about.name == name]
    if not chosen:
        message = f"{name}: no measurement has this name."
        raise DefinitionError(message)
    body = measuring_body(model, ScapeEvaluator(model), chosen)

    def measured(shape: Shape) -> float:
        return float(measurement_values(body, np.asarray(shape, dtype=np.float64))[0])

    return measured


def surface_length_attribute(model: BodyModel, path: SurfacePath) -> Attribute:
    """H(β): length of a way over the body at rest, centimetres."""

    def length(shape: Shape) -> float:
        return 100.0 * path.length_m(rest_vertices(model, shape))

    return length


def path_between_landmarks(
    model: BodyModel, start: str, end: str, vertices: Vertices | None = None
) -> SurfacePath:
    """The shortest way over a body at rest between the skin nearest to two landmarks.

    Over the mean body unless another one's vertices are given.
    """
    vertices = model.mean_vertices if vertices is None else vertices
    points = regress(model.landmarks, model.mean_vertices)
    first, last = (
        int(np.argmin(np.linalg.norm(model.mean_vertices - point, axis=1)))
        for point in (points[model.landmarks.names.index(name)] for name in (start, end))
    )
    return shortest_path(vertices, model.triangles, first, last)
