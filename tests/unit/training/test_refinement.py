import numpy as np
import pytest
import trimesh

from fitter.numerics.mesh_topology import mesh_topology
from fitter.numerics.meshes import enclosed_volume
from fitter.training.report.refinement_effect import (
    flat_refinement,
    halved_edges,
    refined_triangles,
    smooth_refinement,
)

SPHERE = trimesh.creation.icosphere(subdivisions=2)
VERTICES = np.asarray(SPHERE.vertices, dtype=np.float64)
TRIANGLES = np.asarray(SPHERE.faces, dtype=np.int32)
EDGES = halved_edges(TRIANGLES, len(VERTICES))
FINE = refined_triangles(TRIANGLES, len(VERTICES))


def test_a_refined_mesh_is_closed_and_has_four_triangles_for_one():
    assert len(FINE) == 4 * len(TRIANGLES)
    mesh_topology(FINE, vertex_count=len(VERTICES) + len(EDGES))


def test_halving_edges_where_they_run_leaves_the_surface_alone():
    fine = flat_refinement(VERTICES, EDGES)
    assert enclosed_volume(fine, FINE) == pytest.approx(enclosed_volume(VERTICES, TRIANGLES))
    areas = trimesh.Trimesh(fine, FINE, process=False).area_faces.reshape(-1, 4).sum(axis=1)
    np.testing.assert_allclose(areas, SPHERE.area_faces)


def test_smooth_middles_lie_on_the_sphere_that_the_mesh_stands_for():
    fine = smooth_refinement(VERTICES, TRIANGLES, EDGES)
    np.testing.assert_array_equal(fine[: len(VERTICES)], VERTICES)
    flat_gap = 1.0 - np.linalg.norm(flat_refinement(VERTICES, EDGES), axis=1)
    smooth_gap = 1.0 - np.linalg.norm(fine, axis=1)
    assert np.abs(smooth_gap).max() < 0.15 * flat_gap.max()


def test_a_flat_surface_stays_flat():
    box = trimesh.creation.box()
    vertices, triangles = np.asarray(box.vertices), np.asarray(box.faces, dtype=np.int32)
    # Three box refinements: the middle of each side then has level neighbours only.
    for _ in range(3):
        edges = halved_edges(triangles, len(vertices))
        triangles, vertices = (
            refined_triangles(triangles, len(vertices)),
            flat_refinement(vertices, edges),
        )
    edges = halved_edges(triangles, len(vertices))
    fine = smooth_refinement(vertices, triangles, edges)
    inner = (np.abs(vertices[edges]) < 0.4).sum(axis=2).min(axis=1) == 2
    assert inner.sum() > 100
    np.testing.assert_allclose(np.abs(fine[len(vertices) :][inner]).max(axis=1), 0.5)
