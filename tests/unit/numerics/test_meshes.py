import numpy as np
import pytest
import trimesh
from scipy.spatial.transform import Rotation

from fitter.numerics.meshes import (
    add_normal_derivative,
    enclosed_volume,
    grown,
    mesh_part,
    mesh_topology,
    summed_cross_products,
    triangle_neighbours,
    vertex_rings,
    volume_gradient,
)
from tests.unit.measurement.solids import prism, sphere
from tests.unit.numerics.plain_normals import normal_change

SQUARE = [(0, 0), (0, 1), (1, 1), (1, 0)]


def test_a_box_has_the_volume_of_its_sides():
    vertices, triangles = prism(SQUARE, heights=[0.0, 0.5, 2.0])
    assert enclosed_volume(vertices * [1.0, 1.0, 3.0], triangles) == pytest.approx(6.0, abs=1e-12)


def test_a_box_turned_inside_out_has_negative_volume():
    vertices, triangles = prism(SQUARE, heights=[0.0, 1.0])
    assert enclosed_volume(vertices, triangles[:, ::-1]) == pytest.approx(-1.0)


def test_volume_does_not_depend_on_where_the_body_stands_or_turns():
    vertices, triangles = sphere(radius=0.4)
    rotation = Rotation.from_rotvec([1.0, 2.0, -0.5]).as_matrix()
    moved = vertices @ rotation.T + [100.0, -50.0, 7.0]
    volume = enclosed_volume(vertices, triangles)
    assert volume == pytest.approx(4 / 3 * np.pi * 0.4**3, rel=2e-4)
    assert enclosed_volume(moved, triangles) == pytest.approx(volume, rel=1e-12)


def test_the_gradient_of_a_volume_is_that_of_finite_differences():
    vertices, triangles = prism(SQUARE, heights=[0.0, 0.5, 2.0])
    change = np.random.default_rng(1).normal(size=vertices.shape)
    ahead, behind = (enclosed_volume(vertices + step * change, triangles) for step in (1e-4, -1e-4))
    slope = float((volume_gradient(vertices, triangles) * change).sum())
    assert slope == pytest.approx((ahead - behind) / 2e-4, rel=1e-7)


def test_neighbours_share_the_edge_they_are_listed_for():
    _, triangles = prism(SQUARE, heights=[0.0, 1.0, 2.0])
    neighbours = triangle_neighbours(triangles)
    assert (neighbours >= 0).all()
    for triangle, across in zip(triangles, neighbours, strict=True):
        for corner in range(3):
            edge = {int(triangle[corner]), int(triangle[(corner + 1) % 3])}
            assert edge < {int(v) for v in triangles[across[corner]]}


def test_an_edge_of_an_open_mesh_has_no_neighbour():
    assert triangle_neighbours(np.array([[0, 1, 2], [0, 2, 3]])).tolist() == [
        [-1, -1, 1],
        [0, -1, -1],
    ]


def test_a_sphere_satisfies_eulers_formula():
    mesh = trimesh.creation.icosphere(subdivisions=2)
    topology = mesh_topology(np.array(mesh.faces), vertex_count=len(mesh.vertices))
    assert len(mesh.vertices) - len(topology.edges) + len(mesh.faces) == 2


def test_both_triangles_of_an_edge_hold_its_vertices_in_opposite_order():
    mesh = trimesh.creation.icosphere(subdivisions=2)
    triangles = np.array(mesh.faces)
    topology = mesh_topology(triangles, vertex_count=len(mesh.vertices))
    for (low, high), (forward, backward) in zip(
        topology.edges, topology.edge_triangles, strict=True
    ):
        assert low < high
        for triangle, start, end in ((forward, low, high), (backward, high, low)):
            corners = list(triangles[triangle])
            assert corners[(corners.index(start) + 1) % 3] == end


def test_an_open_mesh_is_refused():
    mesh = trimesh.creation.box()
    with pytest.raises(ValueError, match="closed"):
        mesh_topology(np.array(mesh.faces)[1:], vertex_count=8)


def test_an_inconsistently_oriented_mesh_is_refused():
    triangles = np.array(trimesh.creation.box().faces)
    triangles[0] = triangles[0, ::-1]
    with pytest.raises(ValueError, match="oriented"):
        mesh_topology(triangles, vertex_count=8)


# A chain of six vertices.
EDGES = np.array([[k, k + 1] for k in range(5)])


def of(*vertices: int) -> np.ndarray:
    members = np.zeros(6, dtype=bool)
    members[list(vertices)] = True
    return members


def test_a_part_keeps_the_edges_between_its_vertices_under_their_new_numbers():
    part = mesh_part(of(1, 2, 4, 5), EDGES)
    np.testing.assert_array_equal(part.vertices, [1, 2, 4, 5])
    np.testing.assert_array_equal(part.edge_ids, [1, 4])
    np.testing.assert_array_equal(part.edges, [[0, 1], [2, 3]])


def test_growing_reaches_one_edge_further_with_each_ring():
    np.testing.assert_array_equal(grown(of(0), EDGES, 0), of(0))
    np.testing.assert_array_equal(grown(of(0), EDGES, 2), of(0, 1, 2))
    np.testing.assert_array_equal(grown(of(3), EDGES, 1), of(2, 3, 4))


def test_growing_leaves_what_it_was_given():
    start = of(2)
    grown(start, EDGES, 3)
    np.testing.assert_array_equal(start, of(2))


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
