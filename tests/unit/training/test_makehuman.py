from pathlib import Path

import numpy as np
import pytest

from fitter.numerics.meshes import enclosed_volume, triangle_neighbours
from fitter.training.makehuman.meshes import DATA_PACKAGE, BaseMesh, load_targets, makehuman_folder
from tests.unit.training.makehuman_data import base_mesh, needs_makehuman

pytestmark = needs_makehuman


REPOSITORY = Path(__file__).parents[3]


@pytest.fixture(scope="module")
def base() -> BaseMesh:
    return base_mesh()


def test_the_body_is_closed_manifold_and_of_genus_zero(base: BaseMesh):
    triangles = base.triangles
    directed = np.concatenate([triangles[:, [k, (k + 1) % 3]] for k in range(3)])
    assert len(np.unique(directed, axis=0)) == len(directed), "an edge runs twice one way"
    assert (triangle_neighbours(triangles) >= 0).all()
    assert len(base.body_vertex_ids) - len(directed) // 2 + len(triangles) == 2


def test_every_body_vertex_is_used_and_triangles_face_outwards(base: BaseMesh):
    assert np.array_equal(np.unique(base.triangles), np.arange(len(base.body_vertex_ids)))
    assert enclosed_volume(base.body(base.source_vertices), base.triangles) > 0.04


def test_the_mirror_is_an_involution_that_maps_the_body_onto_itself(base: BaseMesh):
    vertices = base.body(base.source_vertices)
    assert np.array_equal(base.mirror[base.mirror], np.arange(len(vertices)))
    np.testing.assert_allclose(vertices[base.mirror] * [-1.0, 1.0, 1.0], vertices, atol=1e-12)
    faces = {tuple(sorted(corner)) for corner in base.triangles.tolist()}
    assert faces == {tuple(sorted(corner)) for corner in base.mirror[base.triangles].tolist()}


def test_the_body_stands_in_the_body_frame_in_metres(base: BaseMesh):
    vertices = base.source_vertices
    left_hand = vertices[base.groups["joint-l-hand"]].mean(axis=0)
    toe = vertices[base.groups["joint-l-toe-1-3"]].mean(axis=0)
    ankle = vertices[base.groups["joint-l-ankle"]].mean(axis=0)
    assert left_hand[0] > 0.2
    assert toe[2] > ankle[2] + 0.05
    body = base.body(vertices)
    assert 1.3 < np.ptp(body[:, 1]) < 2.0


def test_texture_triangles_are_the_triangles_of_the_same_corners(base: BaseMesh):
    # Each texture vertex belongs to one vertex; a vertex on a seam has several.
    owner = np.full(len(base.uv), -1)
    owner[base.uv_triangles.ravel()] = base.triangles.ravel()
    assert np.array_equal(owner[base.uv_triangles], base.triangles)
    assert base.uv.min() >= 0.0
    assert base.uv.max() <= 1.0


def test_mirrored_targets_move_mirrored_vertices(base: BaseMesh):
    left, right = load_targets(
        makehuman_folder(),
        ("arms/l-upperarm-fat-incr", "arms/r-upperarm-fat-incr"),
        len(base.source_vertices),
    )
    assert np.abs(left).max() > 0.005
    mirrored = base.body(left)[base.mirror] * [-1.0, 1.0, 1.0]
    np.testing.assert_allclose(mirrored, base.body(right), atol=2e-4)


def test_who_lacks_the_package_is_told_of_the_version_that_the_tests_have():
    required = (REPOSITORY / "requirements-training.txt").read_text().split()
    assert DATA_PACKAGE in required
