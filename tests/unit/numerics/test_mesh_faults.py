import numpy as np
import pytest
import trimesh

from fitter.numerics.mesh_faults import closed_surface_fault, solid_fault

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
