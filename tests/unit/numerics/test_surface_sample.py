"""Vertices that stand for a surface."""

import numpy as np
import pytest
import trimesh
from scipy import sparse
from scipy.sparse.csgraph import dijkstra

from fitter.numerics.meshes import mesh_topology, vertex_areas
from fitter.numerics.surface_sample import SurfaceSample, surface_sample

SPACING = 0.35


@pytest.fixture(scope="module")
def sphere() -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """A unit sphere a half of which is four times as dense as the other."""
    mesh = trimesh.creation.icosphere(subdivisions=2)
    mesh = mesh.subdivide(np.flatnonzero(mesh.triangles_center[:, 2] > 0.1))
    mesh = trimesh.convex.convex_hull(
        mesh.vertices / np.linalg.norm(mesh.vertices, axis=1)[:, None]
    )
    vertices, triangles = np.array(mesh.vertices), np.array(mesh.faces)
    topology = mesh_topology(triangles, vertex_count=len(vertices))
    return vertices, topology.edges, vertex_areas(vertices, triangles)


@pytest.fixture(scope="module")
def sample(sphere) -> SurfaceSample:
    return surface_sample(*sphere, spacing=SPACING)


def test_no_two_are_nearer_than_the_spacing_and_none_is_farther_from_all(sphere, sample):
    vertices, edges, _ = sphere
    lengths = np.linalg.norm(vertices[edges[:, 0]] - vertices[edges[:, 1]], axis=1)
    graph = sparse.coo_array((lengths, edges.T), shape=(len(vertices),) * 2)
    distances = dijkstra(graph.tocsr(), directed=False, indices=sample.vertices)
    between = distances[:, sample.vertices]
    assert between[~np.eye(len(between), dtype=bool)].min() >= SPACING
    assert distances.min(axis=0).max() < SPACING


def test_areas_add_up_to_the_whole_and_belong_to_the_chosen(sphere, sample):
    vertices, _, _ = sphere
    assert sample.areas.sum() == pytest.approx(1.0)
    np.testing.assert_array_equal(np.flatnonzero(sample.areas), sample.vertices)
    above = vertices[:, 2] > 0.0
    assert sample.areas[above].sum() == pytest.approx(0.5, abs=0.06)


def test_edges_hang_the_chosen_together(sample):
    count = len(sample.vertices)
    assert (sample.edges[:, 0] < sample.edges[:, 1]).all()
    assert len(np.unique(sample.edges, axis=0)) == len(sample.edges)
    graph = sparse.coo_array((np.ones(len(sample.edges)), sample.edges.T), shape=(count, count))
    assert sparse.csgraph.connected_components(graph, directed=False)[0] == 1


def test_a_spacing_below_all_edges_leaves_the_mesh_as_it_is(sphere):
    vertices, edges, areas = sphere
    whole = surface_sample(vertices, edges, areas, spacing=1e-6)
    np.testing.assert_array_equal(whole.vertices, np.arange(len(vertices)))
    np.testing.assert_array_equal(whole.edges, edges)
    np.testing.assert_allclose(whole.areas, areas / areas.sum())
