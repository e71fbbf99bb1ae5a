import numpy as np
import pytest
import trimesh

from fitter.numerics.mesh_topology import mesh_topology


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


def test_neighbours_are_the_other_ends_of_a_vertexs_edges():
    mesh = trimesh.creation.box()
    topology = mesh_topology(np.array(mesh.faces), vertex_count=8)
    for vertex in range(8):
        first, end = topology.neighbour_pointers[vertex : vertex + 2]
        expected = {int(other) for edge in topology.edges if vertex in edge for other in edge} - {
            vertex
        }
        assert list(topology.neighbours[first:end]) == sorted(expected)


def test_an_open_mesh_is_refused():
    mesh = trimesh.creation.box()
    with pytest.raises(ValueError, match="closed"):
        mesh_topology(np.array(mesh.faces)[1:], vertex_count=8)


def test_an_inconsistently_oriented_mesh_is_refused():
    triangles = np.array(trimesh.creation.box().faces)
    triangles[0] = triangles[0, ::-1]
    with pytest.raises(ValueError, match="oriented"):
        mesh_topology(triangles, vertex_count=8)
