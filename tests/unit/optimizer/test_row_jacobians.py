"""Jacobians of rows, and the factor of pairs."""

import numpy as np
import pytest
import trimesh
from scipy import sparse
from scipy.sparse.linalg import spsolve

from fitter.body.tangent import linearise
from fitter.energies.rows import PositionRows, ShadingRows
from fitter.numerics.meshes import mesh_topology
from fitter.numerics.surface_sample import elimination_order
from fitter.optimizer.normal_equations import position_row_jacobian, scatter, shading_row_jacobian
from fitter.optimizer.reflectance_solve import PairFactor
from tests.unit.body.plain_tangent import attached_vertices, direction_jacobian, point_jacobian
from tests.unit.numerics.plain_normals import normal_change
from tests.unit.optimizer.rendered_scene import RenderedScene, rendered_scene

ROWS = 40


@pytest.fixture(scope="module")
def scene() -> RenderedScene:
    return rendered_scene(1)


def test_rows_of_two_points_are_the_dense_jacobian_contracted(scene):
    rng = np.random.default_rng(0)
    vertices = scene.operators.evaluator.vertices(scene.start)
    points = rng.integers(len(vertices), size=(ROWS, 2))
    rows = PositionRows(
        residuals=rng.standard_normal(ROWS),
        weights=rng.random(ROWS),
        points=points,
        derivatives=rng.standard_normal((ROWS, 2, 3)),
    )
    tangent = scene.operators.tangent
    frame = linearise(tangent, scene.start)
    dense = point_jacobian(
        frame, attached_vertices(tangent, points.ravel()), vertices[points.ravel()]
    ).reshape(ROWS, 2, 3, -1)
    expected = np.einsum("kqi,kqic->kc", rows.derivatives, dense)
    np.testing.assert_allclose(
        position_row_jacobian(rows, frame, tangent.vertices, vertices),
        np.sqrt(rows.weights)[:, None] * expected,
        atol=1e-9,
    )


def test_shading_rows_are_the_dense_jacobians_contracted(scene):
    rng = np.random.default_rng(1)
    operators = scene.operators
    model, tangent = operators.model, operators.tangent
    candidate = scene.objective.evaluate(scene.start)
    rows = ShadingRows(
        residuals=rng.standard_normal(ROWS),
        weights=rng.random(ROWS),
        vertices=rng.choice(len(candidate.vertices), ROWS, replace=False),
        position_derivatives=rng.standard_normal((ROWS, 3)),
        normal_derivatives=rng.standard_normal((ROWS, 3)),
        centre_derivatives=rng.standard_normal((ROWS, 3)),
    )
    frame = linearise(tangent, scene.start)
    attachments = attached_vertices(tangent, rows.vertices)
    rest = model.mean_vertices + np.tensordot(scene.start.shape, model.shape_basis, axes=1)
    change = normal_change(rest, model.triangles, rows.vertices, model.shape_basis)
    by_normal = direction_jacobian(
        frame, attachments, candidate.rendering.vertex_normals[rows.vertices], change
    )
    by_position = point_jacobian(frame, attachments, candidate.vertices[rows.vertices])
    expected = np.einsum("ki,kic->kc", rows.position_derivatives, by_position)
    expected += np.einsum("ki,kic->kc", rows.normal_derivatives, by_normal)
    place = slice(scene.start.pose.size, scene.start.pose.size + 3)
    expected[:, place] += rows.centre_derivatives
    np.testing.assert_allclose(
        shading_row_jacobian(rows, frame, operators, candidate),
        np.sqrt(rows.weights)[:, None] * expected,
        atol=1e-9,
    )


def test_points_named_twice_gather_both_shares():
    rows = PositionRows(
        residuals=np.array([2.0, 3.0]),
        weights=np.array([1.0, 0.5]),
        points=np.array([[1, 1], [1, 0]]),
        derivatives=np.ones((2, 2, 3)),
    )
    derivative = np.zeros((2, 3))
    scatter(rows, derivative)
    np.testing.assert_allclose(derivative, [[1.5] * 3, [5.5] * 3])


@pytest.fixture(scope="module")
def edges():
    sphere = trimesh.creation.icosphere(subdivisions=3)
    count = len(sphere.vertices)
    return mesh_topology(sphere.faces.astype(np.int32), vertex_count=count).edges


def whole(between, own, edges):
    """The same matrix, first unknowns before second ones."""
    count = len(own)
    first, second = edges.T
    blocks = [
        sparse.coo_array((values, (first, second)), shape=(count, count)) for values in between.T
    ]
    coupling = sparse.diags_array(own[:, 1])
    diagonals = [sparse.diags_array(own[:, place]) for place in (0, 2)]
    albedo, specularity = (
        block + block.T + diagonal for block, diagonal in zip(blocks, diagonals, strict=True)
    )
    return sparse.block_array([[albedo, coupling], [coupling, specularity]]).tocsc()


@pytest.mark.parametrize("seed", [1, 2])
def test_solutions_are_those_of_a_general_solver(edges, seed):
    """Twice with one pattern: the second matrix finds nothing of the first."""
    rng = np.random.default_rng(seed)
    count = int(edges.max()) + 1
    factor = PairFactor(edges, elimination_order(edges, count))
    for _ in range(2):
        between = -rng.uniform(0.1, 2.0, (len(edges), 2))
        degrees = np.stack(
            [np.bincount(edges.ravel(), np.repeat(-each, 2), count) for each in between.T], axis=1
        )
        d, s = rng.uniform(0.0, 1.0, (2, count))
        own = np.stack([degrees[:, 0] + d * d, d * s, degrees[:, 1] + s * s], axis=1)
        own[:, [0, 2]] += 1e-3
        right = rng.normal(size=(count, 2, 3))
        factor.factorise(between, own)
        expected = spsolve(whole(between, own, edges), np.concatenate([right[:, 0], right[:, 1]]))
        solved = factor.solve(right)
        np.testing.assert_allclose(solved[:, 0], expected[:count], rtol=1e-8, atol=1e-9)
        np.testing.assert_allclose(solved[:, 1], expected[count:], rtol=1e-8, atol=1e-9)


def test_a_part_of_a_mesh_keeps_the_order(edges):
    """Any order gives the solution; a part in the mesh's order stays sparse."""
    count = int(edges.max()) + 1
    kept = np.random.default_rng(3).permutation(count)[: count // 2]
    members = np.zeros(count, dtype=np.bool_)
    members[kept] = True
    vertices = np.flatnonzero(members)
    part = np.searchsorted(vertices, edges[members[edges].all(axis=1)])
    ranks = np.argsort(elimination_order(edges, count))
    inherited, arbitrary = (
        PairFactor(part, order) for order in (np.argsort(ranks[vertices]), np.arange(len(vertices)))
    )
    rng = np.random.default_rng(4)
    between = np.full((len(part), 2), -1.0)
    own = np.tile([9.0, 0.5, 9.0], (len(vertices), 1))
    right = rng.normal(size=(len(vertices), 2, 1))
    inherited.factorise(between, own)
    arbitrary.factorise(between, own)
    np.testing.assert_allclose(inherited.solve(right), arbitrary.solve(right), rtol=1e-10)


def test_an_order_names_every_vertex_once(edges):
    count = int(edges.max()) + 1
    np.testing.assert_array_equal(np.sort(elimination_order(edges, count)), np.arange(count))
