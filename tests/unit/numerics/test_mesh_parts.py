import numpy as np

from fitter.numerics.mesh_topology import grown, mesh_part

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
