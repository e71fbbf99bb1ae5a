import numpy as np
import trimesh

from fitter.training.articulation.parts import cut_into_parts

SPHERE = trimesh.creation.icosphere(subdivisions=2)
TRIANGLES = np.asarray(SPHERE.faces)
VERTICES = np.asarray(SPHERE.vertices)


def soft_halves():
    upper = 1.0 / (1.0 + np.exp(-8.0 * VERTICES[:, 2]))
    noise = np.full((len(VERTICES), 3), 1e-3)
    weights = np.concatenate([upper[:, None], 1.0 - upper[:, None], noise], axis=1)
    return weights / weights.sum(axis=1, keepdims=True)


def test_a_triangle_belongs_to_the_part_its_corners_follow_most():
    parts = cut_into_parts(TRIANGLES, soft_halves())
    centres = VERTICES[TRIANGLES].mean(axis=1)
    clear = np.abs(centres[:, 2]) > 0.05
    np.testing.assert_array_equal(
        parts.part_of_triangle[clear], np.where(centres[clear, 2] > 0, 0, 1)
    )


def test_incidences_list_the_vertices_each_part_touches_once():
    parts = cut_into_parts(TRIANGLES, soft_halves())
    for part in range(5):
        start, stop = parts.incidence_pointers[part : part + 2]
        expected = np.unique(TRIANGLES[parts.part_of_triangle == part])
        np.testing.assert_array_equal(parts.incidence_vertices[start:stop], expected)


def test_kept_skinning_weights_are_the_largest_and_sum_to_one():
    weights = soft_halves()
    parts = cut_into_parts(TRIANGLES, weights)
    np.testing.assert_allclose(parts.skinning_weights.sum(axis=1), 1.0)
    np.testing.assert_array_equal(parts.skinning_parts[:, 0], np.argmax(weights, axis=1))
    assert (np.diff(parts.skinning_weights, axis=1) <= 0).all()
