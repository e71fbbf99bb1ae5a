"""Contracted rows against the dense tangent they stand for."""

import numpy as np
import pytest

from fitter.body.tangent import linearise
from fitter.energies.rows import PositionRows, ShadingRows
from fitter.optimizer.normal_equations import position_row_jacobian, scatter, shading_row_jacobian
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
