import numpy as np
import trimesh

from fitter.training.shapes.surface_paths import SurfacePath, shortest_path

SPHERE = trimesh.creation.icosphere(subdivisions=3)
VERTICES, TRIANGLES = np.asarray(SPHERE.vertices), np.asarray(SPHERE.faces, dtype=np.int32)


def grid(width: int, height: int):
    """A flat sheet of unit squares, all cut along the same diagonal."""
    x, y = np.meshgrid(np.arange(width), np.arange(height), indexing="ij")
    vertices = np.stack([x, y, np.zeros_like(x)], axis=2).reshape(-1, 3).astype(float)
    corner = (np.arange(width - 1)[:, None] * height + np.arange(height - 1)).ravel()
    lower = np.stack([corner, corner + height, corner + height + 1], axis=1)
    upper = np.stack([corner, corner + height + 1, corner + 1], axis=1)
    return vertices, np.concatenate([lower, upper]).astype(np.int32)


def test_on_a_flat_sheet_the_way_is_straight_against_the_grain_of_the_mesh():
    vertices, triangles = grid(12, 9)
    start, end = 8, 11 * 9 + 0  # from one corner to the far one, across every diagonal
    path = shortest_path(vertices, triangles, start, end)
    np.testing.assert_allclose(path.length_m(vertices), np.hypot(11, 8), rtol=2e-3)


def test_on_a_sphere_ways_are_arcs_of_great_circles():
    rng = np.random.default_rng(0)
    for start, end in rng.choice(len(VERTICES), (6, 2), replace=False):
        angle = np.arccos(np.clip(VERTICES[start] @ VERTICES[end], -1.0, 1.0))
        length = shortest_path(VERTICES, TRIANGLES, int(start), int(end)).length_m(VERTICES)
        # The mesh lies within the sphere, so a way over it may be a little shorter.
        assert 0.99 * angle < length < 1.001 * angle


def test_the_way_begins_and_ends_at_its_vertices_and_steps_over_single_triangles():
    path = shortest_path(VERTICES, TRIANGLES, 0, 100)
    points = path.points(VERTICES)
    np.testing.assert_allclose(points[[0, -1]], VERTICES[[0, 100]])
    corners = [set(row) for row in TRIANGLES.tolist()]
    for one, other in zip(path.edges[:-1].tolist(), path.edges[1:].tolist(), strict=True):
        assert any(set(one) | set(other) <= corner for corner in corners)


def test_on_a_scaled_body_the_same_crossings_give_the_scaled_length():
    path = shortest_path(VERTICES, TRIANGLES, 3, 77)
    np.testing.assert_allclose(path.length_m(2.5 * VERTICES), 2.5 * path.length_m(VERTICES))


def test_moving_crossings_changes_a_straightened_way_in_second_order_only():
    vertices, triangles = grid(10, 7)
    path = shortest_path(vertices, triangles, 6, 9 * 7)
    free = (path.share > 0.01) & (path.share < 0.99)
    shift = np.where(free, np.random.default_rng(1).normal(size=len(free)), 0.0)
    lengths = [
        SurfacePath(edges=path.edges, share=path.share + step * shift).length_m(vertices)
        for step in (0.0, 1e-3, 2e-3)
    ]
    assert 0.0 <= lengths[1] - lengths[0] < 1e-3
    np.testing.assert_allclose((lengths[2] - lengths[0]) / (lengths[1] - lengths[0]), 4.0, rtol=0.2)
