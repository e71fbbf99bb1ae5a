import numpy as np

from fitter.numerics.mesh_faults import pierced_triangles
from fitter.numerics.mesh_topology import mesh_topology

TETRAHEDRON = np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]], dtype=np.int32)
CORNERS = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]])


def two_tetrahedra(offset):
    """One, and another shifted by ``offset``: a mesh in two pieces."""
    vertices = np.concatenate([CORNERS, CORNERS + offset])
    triangles = np.concatenate([TETRAHEDRON, TETRAHEDRON + 4])
    edges = mesh_topology(triangles, vertex_count=len(vertices)).edges
    return vertices, triangles, edges


def crossed_by_hand(vertices, triangles, edges):
    """The same by solving for every edge and triangle where they meet."""
    pierced = np.zeros(len(triangles), dtype=bool)
    for t, corners in enumerate(triangles):
        a, b, c = vertices[corners]
        for start, end in edges:
            if start in corners or end in corners:
                continue
            matrix = np.stack([vertices[end] - vertices[start], a - b, a - c], axis=1)
            if abs(np.linalg.det(matrix)) < 1e-12:
                continue
            along, u, v = np.linalg.solve(matrix, a - vertices[start])
            pierced[t] |= 0 < along < 1 and u > 0 and v > 0 and u + v < 1
    return pierced


def test_solids_apart_do_not_cross():
    assert not pierced_triangles(*two_tetrahedra([2.0, 0.0, 0.0])).any()


def test_a_solid_within_another_does_not_cross_it():
    vertices, triangles, edges = two_tetrahedra([0.0, 0.0, 0.0])
    vertices[4:] = 0.2 * CORNERS + 0.1
    assert not pierced_triangles(vertices, triangles, edges).any()


def test_solids_that_overlap_cross_where_their_edges_pierce_triangles():
    rng = np.random.default_rng(0)
    found = 0
    for _ in range(50):
        mesh = two_tetrahedra(rng.uniform(-0.6, 0.6, size=3))
        pierced = pierced_triangles(*mesh)
        np.testing.assert_array_equal(pierced, crossed_by_hand(*mesh))
        found += pierced.sum()
    assert found > 50


def test_neither_scale_nor_place_nor_turn_changes_what_crosses():
    vertices, triangles, edges = two_tetrahedra([0.2, 0.15, 0.1])
    turned = (vertices @ np.linalg.qr(np.random.default_rng(1).normal(size=(3, 3)))[0]) * 0.01 + 7.0
    np.testing.assert_array_equal(
        pierced_triangles(vertices, triangles, edges), pierced_triangles(turned, triangles, edges)
    )
