"""What the shape space itself costs: errors of the coefficients nearest to the true body.

No fit to a picture does better than chance below these; pose, picture and light play no part.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from fitter.arrays import PerVertex, Shape, Vertices
from fitter.body.model import BodyModel
from fitter.fits.prepared_model import PreparedModel, prepared_model
from fitter.measurement.anthropometry import measure
from fitter.numerics.meshes import vertex_areas
from tests.evaluation.people import Person, rig_of_people
from tests.evaluation.truth import true_body


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class ShapeLimit:
    """Of one person.

    ``rest_mm`` is the mean distance of vertices at rest, by area and without the hands, ``errors``
    measured minus true in centimetres and kilograms, ``length`` the norm of the coefficients in
    standard deviations.
    """

    rest_mm: float
    errors: Mapping[str, float]
    length: float


def shape_limit(person: Person) -> ShapeLimit:
    """Of the coefficients nearest to a person."""
    body = prepared_model(person.gender)
    shape = nearest_shape(person)
    areas = _areas_without_hands(body)
    left_over = _centred(_rest(person) - _rest_of(body.operators.model, shape), areas)
    truth = true_body(person).measurements
    found = {each.name: each.value for each in measure(body.measuring, shape)}
    return ShapeLimit(
        rest_mm=1000.0 * float(areas @ np.linalg.norm(left_over, axis=1)),
        errors={name: value - truth[name] for name, value in found.items()},
        length=float(np.linalg.norm(shape)),
    )


def nearest_shape(person: Person) -> Shape:
    """Least squares over the skin at rest by area, wherever the body stands.

    Hands are left out: the people's fingers are straight, the model's relaxed.
    """
    body = prepared_model(person.gender)
    model = body.operators.model
    areas = _areas_without_hands(body)
    # Centred alike, neither side says where the body stands.
    missing = _centred(_rest(person) - model.mean_vertices, areas)
    basis = np.stack([_centred(axis, areas) for axis in model.shape_basis])
    scale = np.sqrt(areas)[:, None]
    columns = (scale * basis).reshape(len(basis), -1).T
    return np.linalg.lstsq(columns, (scale * missing).ravel())[0]


def _rest(person: Person) -> Vertices:
    return rig_of_people().surface.body(person.source_vertices)


def _rest_of(model: BodyModel, shape: Shape) -> Vertices:
    return model.mean_vertices + np.tensordot(shape, model.shape_basis, axes=1)


def _areas_without_hands(body: PreparedModel) -> PerVertex:
    model = body.operators.model
    areas = vertex_areas(model.mean_vertices, model.triangles)
    for part in ("left_hand", "right_hand"):
        triangles = model.triangles[model.part_of_triangle == model.part_names.index(part)]
        areas[triangles.ravel()] = 0.0
    return areas / areas.sum()


def _centred(points: Vertices, weights: PerVertex) -> Vertices:
    return points - weights @ points
