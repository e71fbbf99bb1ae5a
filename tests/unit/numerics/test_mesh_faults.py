import numpy as np
import pytest
import trimesh

from fitter.numerics.mesh_faults import closed_surface_fault, pierced_triangles, solid_fault
from fitter.numerics.meshes import mesh_topology

BOX = trimesh.creation.box()
VERTICES = np.asarray(BOX.vertices)
TRIANGLES = np.asarray(BOX.faces)


def fault(triangles, count=8):
    return closed_surface_fault(np.asarray(triangles), vertex_count=count) or ""


def test_a_box_has_no_fault():
    assert fault(TRIANGLES) == ""
    assert solid_fault(VERTICES, TRIANGLES) is None


def test_a_missing_triangle_leaves_a_hole_of_three_edges():
    assert "hole: 3 edges" in fault(TRIANGLES[1:])


def test_a_third_triangle_at_an_edge_is_not_manifold():
    fin = [[*TRIANGLES[0][:2], 8], [*TRIANGLES[0][1::-1], 8]]
    assert "not manifold: 1 edges" in fault([*TRIANGLES, *fin], 9)


def test_a_turned_triangle_disagrees_with_its_three_neighbours():
    turned = TRIANGLES.copy()
    turned[5] = turned[5][::-1]
    assert "the two triangles of 3 edges" in fault(turned)


def test_a_vertex_without_triangle_is_counted():
    assert "leaves 1 vertices without a triangle, the first is 8" in fault(TRIANGLES, 9)


def test_a_triangle_on_two_vertices_is_named():
    pinched = TRIANGLES.copy()
    pinched[7] = [3, 3, 1]
    assert "corner twice, the first is 7" in fault(pinched)


def test_two_boxes_are_two_pieces():
    assert "2 pieces" in fault(np.concatenate([TRIANGLES, TRIANGLES + 8]), 16)


@pytest.mark.parametrize("characteristic", [0, 3])
def test_a_ring_and_boxes_that_touch_in_a_vertex_are_no_sphere(characteristic):
    if characteristic == 0:
        ring = trimesh.creation.torus(1.0, 0.3, major_sections=8, minor_sections=6)
        triangles, count = np.asarray(ring.faces), len(ring.vertices)
    else:
        other = TRIANGLES + 8
        other[other == 8] = 0
        triangles, count = np.concatenate([TRIANGLES, np.where(other > 8, other - 1, other)]), 15
    assert f"Euler characteristic {characteristic}, not 2" in fault(triangles, count)


def test_a_surface_turned_inside_out_and_one_pressed_flat_enclose_nothing():
    assert "inside out" in (solid_fault(VERTICES, TRIANGLES[:, ::-1]) or "")
    assert "8 triangles no area" in (solid_fault(VERTICES * [1, 0, 0.5], TRIANGLES) or "")


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
