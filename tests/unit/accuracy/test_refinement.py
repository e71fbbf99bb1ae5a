import numpy as np
import pytest

from tests.accuracy.refinement import refined, triangulated, vertex_normals

CUBE = np.array([[x, y, z] for x in (0.0, 1.0) for y in (0.0, 1.0) for z in (0.0, 1.0)])
CUBE_QUADS = np.array(
    [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
)


def test_a_refined_cube_is_the_same_cube_of_many_small_quads():
    fine = refined(CUBE_QUADS, len(CUBE), times=2)
    vertices = fine.rows @ CUBE
    a, b, c = (vertices[triangulated(fine.quads)[:, k]] for k in range(3))
    areas = 0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1)
    assert len(fine.quads) == 16 * len(CUBE_QUADS)
    np.testing.assert_allclose(areas, 1.0 / 32.0)
    np.testing.assert_allclose(vertices[: len(CUBE)], CUBE)
    volume = abs(np.einsum("fx,fx->", a, np.cross(b, c))) / 6.0
    assert volume == pytest.approx(1.0, abs=1e-12)


def test_a_refined_closed_mesh_stays_closed():
    fine = refined(CUBE_QUADS, len(CUBE), times=3)
    # V - E + F of a sphere, every edge between two quads.
    edges = np.sort(
        np.stack([fine.quads, np.roll(fine.quads, -1, axis=1)], axis=2).reshape(-1, 2), axis=1
    )
    unique, count = np.unique(edges, axis=0, return_counts=True)
    assert (count == 2).all()
    assert fine.rows.shape[0] - len(unique) + len(fine.quads) == 2


def test_normals_of_a_cubes_corners_point_along_its_diagonals():
    normals = vertex_normals(CUBE, triangulated(CUBE_QUADS))
    outward = CUBE - 0.5
    cosines = np.einsum("mx,mx->m", normals, outward) / np.linalg.norm(outward, axis=1)
    assert (np.abs(cosines) > 0.9).all()
    assert len(set(np.sign(cosines))) == 1
