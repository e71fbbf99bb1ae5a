"""Vertex normals and their derivatives."""

import numpy as np
import pytest
import trimesh

from fitter.numerics.normals import add_normal_derivative, summed_cross_products, vertex_rings
from tests.unit.numerics.plain_normals import normal_change


@pytest.fixture(scope="module")
def mesh() -> tuple[np.ndarray, np.ndarray]:
    sphere = trimesh.creation.icosphere(subdivisions=2)
    rng = np.random.default_rng(0)
    vertices = np.asarray(sphere.vertices) * [1.0, 1.3, 0.7]
    return vertices + 0.02 * rng.standard_normal(vertices.shape), sphere.faces.astype(np.int32)


def unit_normals(vertices, triangles):
    sums = summed_cross_products(vertices, triangles)
    return sums / np.linalg.norm(sums, axis=1, keepdims=True)


def test_normals_of_a_sphere_point_outward():
    sphere = trimesh.creation.icosphere(subdivisions=3)
    normals = unit_normals(np.array(sphere.vertices), sphere.faces.astype(np.int32))
    assert (np.einsum("ij,ij->i", normals, sphere.vertices) > 0.999).all()


def test_pulling_a_normal_derivative_back_agrees_with_finite_differences(mesh):
    vertices, triangles = mesh
    rng = np.random.default_rng(1)
    chosen = np.arange(0, len(vertices), 3)
    weights = rng.standard_normal((len(chosen), 3))
    direction = rng.standard_normal(vertices.shape)
    rings = vertex_rings(triangles, len(vertices))
    before = rng.standard_normal(vertices.shape)
    after = before.copy()
    add_normal_derivative(vertices, triangles, rings, chosen, weights, after)
    exact = ((after - before) * direction).sum()
    step = 1e-6
    plus = (weights * unit_normals(vertices + step * direction, triangles)[chosen]).sum()
    minus = (weights * unit_normals(vertices - step * direction, triangles)[chosen]).sum()
    assert exact == pytest.approx((plus - minus) / (2 * step), rel=1e-6)


def test_the_change_of_normals_agrees_with_finite_differences(mesh):
    vertices, triangles = mesh
    rng = np.random.default_rng(2)
    moves = rng.standard_normal((3, *vertices.shape))
    chosen = np.array([0, 5, 40, 100], dtype=np.int32)
    change = normal_change(vertices, triangles, chosen, moves)
    step = 1e-6
    for j, move in enumerate(moves):
        plus = unit_normals(vertices + step * move, triangles)[chosen]
        minus = unit_normals(vertices - step * move, triangles)[chosen]
        np.testing.assert_allclose(change[:, j], (plus - minus) / (2 * step), atol=1e-6)
