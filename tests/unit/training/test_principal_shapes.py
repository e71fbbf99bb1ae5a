import numpy as np

from fitter.training.shapes.principal_shapes import centred, principal_shapes, project

RNG = np.random.default_rng(2)
MASSES = RNG.uniform(0.1, 1.0, 50)


def population(deviations, subjects=400):
    """Bodies from a planted orthonormal basis in the metric of the vertices."""
    raw = centred(RNG.normal(size=(len(deviations), 50, 3)), MASSES)
    weights = np.sqrt(MASSES / MASSES.sum())[:, None]
    scaled, _ = np.linalg.qr((raw * weights).reshape(len(deviations), -1).T)
    axes = scaled.T.reshape(raw.shape) / weights
    coefficients = RNG.normal(size=(subjects, len(deviations)))
    coefficients -= coefficients.mean(axis=0)
    mean = centred(RNG.normal(size=(1, 50, 3)), MASSES)[0]
    meshes = mean + np.tensordot(coefficients * deviations, axes, axes=1)
    return mean, meshes


def test_planted_axes_explain_the_population_to_rounding():
    mean, meshes = population(np.array([3.0, 1.0, 0.3]))
    shapes = principal_shapes(meshes, MASSES, 3)
    np.testing.assert_allclose(shapes.mean, mean, atol=1e-12)
    rebuilt = shapes.mean + np.tensordot(shapes.coefficients, shapes.axes, axes=1)
    np.testing.assert_allclose(rebuilt, meshes, atol=1e-10)


def test_coefficients_are_whitened():
    _, meshes = population(np.array([3.0, 1.0, 0.3]))
    covariance = np.cov(principal_shapes(meshes, MASSES, 3).coefficients.T)
    np.testing.assert_allclose(covariance, np.eye(3), atol=1e-10)


def test_axes_are_orthogonal_in_the_metric_and_largest_first():
    _, meshes = population(np.array([3.0, 1.0, 0.3]))
    axes = principal_shapes(meshes, MASSES, 3).axes
    gram = np.einsum("amc,m,bmc->ab", axes, MASSES / MASSES.sum(), axes)
    np.testing.assert_allclose(gram, np.diag(np.diag(gram)), atol=1e-10)
    assert (np.diff(np.diag(gram)) < 0).all()


def test_moving_the_bodies_about_changes_nothing():
    _, meshes = population(np.array([3.0, 1.0]))
    moved = meshes + RNG.normal(size=(len(meshes), 1, 3))
    still, other = (principal_shapes(x, MASSES, 2) for x in (meshes, moved))
    np.testing.assert_allclose(other.mean, still.mean, atol=1e-12)
    np.testing.assert_allclose(np.abs(other.axes), np.abs(still.axes), atol=1e-9)


def test_projection_finds_the_coefficients_of_a_body_wherever_it_stands():
    _, meshes = population(np.array([3.0, 1.0, 0.3]))
    shapes = principal_shapes(meshes, MASSES, 3)
    wanted = RNG.normal(size=(5, 3))
    bodies = shapes.mean + np.tensordot(wanted, shapes.axes, axes=1) + 2.0
    found, residuals = project(bodies, MASSES, shapes.mean, shapes.axes)
    np.testing.assert_allclose(found, wanted, atol=1e-9)
    np.testing.assert_allclose(residuals, 0.0, atol=1e-10)
