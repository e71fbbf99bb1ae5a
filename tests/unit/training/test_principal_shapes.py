import numpy as np
import trimesh
from scipy import sparse
from scipy.sparse.linalg import spsolve

from fitter.numerics.meshes import gradient_operator, part_laplacians, triangle_areas
from fitter.training.articulation.parts import Parts, joined_parts
from fitter.training.articulation.pose_term import STRIDE, vertex_motions
from fitter.training.shapes.principal_shapes import centred, principal_shapes, project

RNG = np.random.default_rng(2)
MASSES = RNG.uniform(0.1, 1.0, 50)


def population(deviations, subjects=400):
    """Bodies from a planted orthonormal basis in the metric of the vertices."""
    draws = np.random.default_rng(102)
    raw = centred(draws.normal(size=(len(deviations), 50, 3)), MASSES)
    weights = np.sqrt(MASSES / MASSES.sum())[:, None]
    scaled, _ = np.linalg.qr((raw * weights).reshape(len(deviations), -1).T)
    axes = scaled.T.reshape(raw.shape) / weights
    coefficients = draws.normal(size=(subjects, len(deviations)))
    coefficients -= coefficients.mean(axis=0)
    mean = centred(draws.normal(size=(1, 50, 3)), MASSES)[0]
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
    draws = np.random.default_rng(3)
    _, meshes = population(np.array([3.0, 1.0]))
    moved = meshes + draws.normal(size=(len(meshes), 1, 3))
    still, other = (principal_shapes(x, MASSES, 2) for x in (meshes, moved))
    np.testing.assert_allclose(other.mean, still.mean, atol=1e-12)
    np.testing.assert_allclose(np.abs(other.axes), np.abs(still.axes), atol=1e-9)


def test_projection_finds_the_coefficients_of_a_body_wherever_it_stands():
    draws = np.random.default_rng(3)
    _, meshes = population(np.array([3.0, 1.0, 0.3]))
    shapes = principal_shapes(meshes, MASSES, 3)
    wanted = draws.normal(size=(5, 3))
    bodies = shapes.mean + np.tensordot(wanted, shapes.axes, axes=1) + 2.0
    found, residuals = project(bodies, MASSES, shapes.mean, shapes.axes)
    np.testing.assert_allclose(found, wanted, atol=1e-9)
    np.testing.assert_allclose(residuals, 0.0, atol=1e-10)


SPHERE = trimesh.creation.icosphere(subdivisions=2)
REST = np.asarray(SPHERE.vertices)
TRIANGLES = np.asarray(SPHERE.faces)


def halves() -> tuple[Parts, list[sparse.csr_array]]:
    upper = (REST[TRIANGLES].mean(axis=1)[:, 2] > 0.0).astype(int)
    weights = np.stack([REST[:, 2] <= 0.0, REST[:, 2] > 0.0], axis=1).astype(float)
    weights = np.concatenate([weights, np.zeros((len(REST), 2))], axis=1)
    parts = joined_parts(TRIANGLES, upper, weights)
    laplacians = part_laplacians(
        gradient_operator(REST, TRIANGLES), triangle_areas(REST, TRIANGLES), upper, 2
    )
    return parts, laplacians


def span(parts: Parts, part: int) -> np.ndarray:
    return parts.incidence_vertices[slice(*parts.incidence_pointers[part : part + 2])]


def answer(laplacians: list[sparse.csr_array], right: np.ndarray) -> np.ndarray:
    """The mesh of a right-hand side, its mean vertex at the origin."""
    total = sparse.csc_matrix(laplacians[0] + laplacians[1])
    total = total + sparse.csc_matrix(([1.0], ([0], [0])), shape=total.shape)
    vertices = np.asarray(spsolve(total, right))
    return vertices - vertices[::STRIDE].mean(axis=0)


def test_an_error_counts_as_what_it_does_to_the_vertices():
    parts, laplacians = halves()
    motions = vertex_motions(laplacians, parts)
    displacement = np.random.default_rng(2).normal(size=REST.shape)
    for part, motion in enumerate(motions):
        vertices = span(parts, part)
        error = (laplacians[part] @ displacement)[vertices]
        right = np.zeros_like(REST)
        right[vertices] = error
        moved = answer(laplacians, right)[::STRIDE]
        expected = np.sqrt((moved**2).sum(axis=1).mean())
        np.testing.assert_allclose(np.linalg.norm(motion @ error), expected, rtol=1e-8)


def test_parts_that_err_together_add_up_to_the_mesh_they_ask_for():
    parts, laplacians = halves()
    motions = vertex_motions(laplacians, parts)
    displacement = REST * [0.1, -0.2, 0.3] + 0.05 * np.sin(3.0 * REST)
    together = sum(
        motion @ (laplacians[part] @ displacement)[span(parts, part)]
        for part, motion in enumerate(motions)
    )
    centred = displacement[::STRIDE] - displacement[::STRIDE].mean(axis=0)
    np.testing.assert_allclose(together * np.sqrt(len(centred)), centred, atol=1e-9)


def test_a_translation_does_not_count():
    parts, laplacians = halves()
    motions = vertex_motions(laplacians, parts)
    shifted = np.ones_like(REST)
    for part, motion in enumerate(motions):
        error = (laplacians[part] @ shifted)[span(parts, part)]
        assert np.abs(motion @ error).max() < 1e-10


def test_smooth_errors_weigh_more_than_rough_ones_of_the_same_size():
    parts, laplacians = halves()
    motion = vertex_motions(laplacians, parts)[0]
    vertices = span(parts, 0)
    smooth = (laplacians[0] @ REST)[vertices]
    rough = (laplacians[0] @ np.random.default_rng(3).normal(size=REST.shape))[vertices]
    sizes = [np.linalg.norm(motion @ e) / np.linalg.norm(e) for e in (smooth, rough)]
    assert sizes[0] > 2.0 * sizes[1]
