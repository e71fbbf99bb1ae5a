"""What the shape space itself costs: errors of the coefficients nearest to the true body.

No fit to a picture does better than chance below these; pose, picture and light play no part.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from fitter.body.skeleton import regress
from fitter.fittable import packaged_body
from fitter.measurement.anthropometry import measure
from tests.evaluation.people import Person, rig_of_people
from tests.evaluation.truth import true_body


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class ShapeLimit:
    """Of one person.

    ``rest_mm`` is the mean distance of vertices at rest, ``errors`` measured minus true in
    centimetres and kilograms, ``length`` the norm of the coefficients in standard deviations.
    """

    rest_mm: float
    errors: Mapping[str, float]
    length: float


def shape_limit(person: Person) -> ShapeLimit:
    """Least squares over the vertices at rest, the root joint at the origin."""
    body = packaged_body(person.gender)
    model = body.instruments.model
    rest = rig_of_people().surface.body(person.source_vertices)
    rest = rest - regress(model.joint_regressor, rest)[0]
    basis = model.shape_basis.reshape(len(model.shape_basis), -1).T
    missing = (rest - model.mean_vertices).ravel()
    shape = np.linalg.lstsq(basis, missing)[0]
    left_over = (missing - basis @ shape).reshape(-1, 3)
    truth = true_body(person).measurements
    found = {each.name: each.value for each in measure(body.measuring, shape)}
    return ShapeLimit(
        rest_mm=1000.0 * float(np.linalg.norm(left_over, axis=1).mean()),
        errors={name: value - truth[name] for name, value in found.items()},
        length=float(np.linalg.norm(shape)),
    )
