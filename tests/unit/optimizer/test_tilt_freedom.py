"""The tilt eliminated from the matrix of body and tilt, and its covariance, in closed form."""

import numpy as np

from fitter.body.tangent import linearise
from fitter.energies.stance import stance_rows
from fitter.optimizer.tilt_freedom import stance_jacobian, tilt_covariance, with_free_tilt
from tests.unit.optimizer.rendered_scene import rendered_scene


def test_eliminating_the_tilt_is_inverting_the_matrix_of_both():
    scene = rendered_scene(1)
    operators, candidate = scene.operators, scene.objective.evaluate(scene.start)
    stance = stance_rows(candidate.joints, operators.stance_vectors, candidate.tilt)
    frame = linearise(operators.tangent, scene.start)
    by_body = stance_jacobian(stance, frame, operators, candidate)
    columns = by_body.shape[1]
    # Whatever else is known of the body.
    known = np.random.default_rng(2).standard_normal((2 * columns, columns))
    other = known.T @ known
    both = np.hstack([by_body, stance.by_tilt])
    matrix = both.T @ both
    matrix[:columns, :columns] += other
    expected = np.linalg.inv(matrix)
    free = with_free_tilt(by_body, stance)
    body = np.linalg.inv(other + free.T @ free)
    np.testing.assert_allclose(body, expected[:columns, :columns], rtol=1e-6, atol=1e-9)
    np.testing.assert_allclose(
        tilt_covariance(operators, candidate, body),
        expected[columns:, columns:],
        rtol=1e-6,
        atol=1e-9,
    )
