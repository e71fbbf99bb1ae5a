"""The metric of right-hand sides against meshes solved with the errors in them."""

import numpy as np
import trimesh
from scipy import sparse
from scipy.sparse.linalg import spsolve

from fitter.numerics.gradient_operators import gradient_operator, part_laplacians
from fitter.numerics.meshes import triangle_areas
from fitter.training.articulation.parts import Parts, joined_parts
from fitter.training.articulation.pose_term import STRIDE, vertex_motions

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
