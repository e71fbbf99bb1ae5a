"""The linear-blend tangent against the exact body."""

import numpy as np

from fitter.body.scape import ScapeEvaluator, increment
from fitter.body.tangent import linearise, tangent_model
from fitter.parameters import BodyParameters
from tests.unit.body.plain_tangent import attached_vertices, point_jacobian
from tests.unit.body.synthetic_model import bar_model


def test_the_tangent_is_exact_for_root_motion_and_close_for_joints_and_shape():
    model = bar_model()
    evaluator = ScapeEvaluator(model)
    tangent = tangent_model(model)
    rng = np.random.default_rng(0)
    parameters = BodyParameters(
        pose=0.2 * rng.standard_normal((3, 3)),
        translation=np.array([0.1, -0.2, 3.0]),
        shape=rng.standard_normal(2),
    )
    chosen = np.array([3, 17, 40, 70, 100, 105])
    jacobian = point_jacobian(
        linearise(tangent, parameters),
        attached_vertices(tangent, chosen),
        evaluator.vertices(parameters)[chosen],
    )
    step = 1e-5
    exact = np.empty_like(jacobian)
    for column in range(jacobian.shape[2]):
        delta = np.zeros(jacobian.shape[2])
        delta[column] = step
        sides = []
        for sign in (1, -1):
            moved = increment(
                parameters,
                pose=sign * delta[:9].reshape(3, 3),
                translation=sign * delta[9:12],
                shape=sign * delta[12:],
            )
            sides.append(evaluator.vertices(moved)[chosen])
        exact[:, :, column] = (sides[0] - sides[1]) / (2 * step)
    np.testing.assert_allclose(jacobian[:, :, :3], exact[:, :, :3], atol=1e-6)
    np.testing.assert_allclose(jacobian[:, :, 9:12], exact[:, :, 9:12], atol=1e-6)
    relative = np.linalg.norm(jacobian - exact) / np.linalg.norm(exact)
    assert relative < 0.15
