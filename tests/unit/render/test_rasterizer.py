"""The z-buffer: closed forms of spheres and planes, outlines, interpolation."""

import cv2
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from fitter.render.camera import Camera
from fitter.render.contours import outline_loops
from fitter.render.rasterizer import Rendering, render, shade_image
from tests.unit.render.shapes import box, camera, sphere, together


def pixel_rays(view: Camera) -> np.ndarray:
    columns, rows = np.meshgrid(np.arange(view.width) + 0.5, np.arange(view.height) + 0.5)
    return view.rays(np.stack([columns, rows], axis=-1))


def cast_rays(vertices: np.ndarray, triangles: np.ndarray, view: Camera) -> np.ndarray:
    """The plain version: nearest z over all triangles for each pixel's ray (Moeller-Trumbore)."""
    rays = pixel_rays(view).reshape(-1, 3)
    nearest = np.full(len(rays), np.inf)
    for a, b, c in vertices[triangles]:
        first, second = b - a, c - a
        across = np.cross(rays, second)
        determinant = across @ first
        with np.errstate(divide="ignore", invalid="ignore"):
            u = (across @ -a) / determinant
            q = np.cross(-a, first)
            v = (rays @ q) / determinant
            z = (second @ q) / determinant
        hit = (u >= 0) & (v >= 0) & (u + v <= 1) & (z > 0)
        nearest = np.where(hit & (z < nearest), z, nearest)
    return nearest.reshape(view.height, view.width)


def rendered_sphere(radius: float, distance: float, view: Camera) -> Rendering:
    return render(*sphere(radius, (0, 0, distance), subdivisions=5), view)


def test_sphere_silhouette_has_the_area_of_its_perspective_outline():
    view = camera()
    rendering = rendered_sphere(0.5, 2.5, view)
    outline_radius = view.focal_length_px * 0.5 / np.sqrt(2.5**2 - 0.5**2)
    assert rendering.silhouette.sum() == pytest.approx(np.pi * outline_radius**2, rel=3e-3)


def test_sphere_depth_is_where_each_ray_meets_the_sphere():
    view = camera()
    rendering = rendered_sphere(0.5, 2.5, view)
    rays = pixel_rays(view)
    squared = (rays**2).sum(axis=-1)
    discriminant = 2.5**2 - squared * (2.5**2 - 0.5**2)
    inside = discriminant > 0.05
    expected = (2.5 - np.sqrt(discriminant[inside])) / squared[inside]
    np.testing.assert_allclose(rendering.depth[inside], expected, atol=1e-3)


@settings(max_examples=15)
@given(seed=st.integers(0, 2**31))
def test_pictures_agree_with_casting_a_ray_at_every_triangle(seed: int):
    random = np.random.default_rng(seed)
    view = camera(width=64, height=48, focal_length_px=60.0)
    vertices, triangles = together(
        box((1.0, 0.6, 0.8), (0, 0, 3.0), rotation=Rotation.random(rng=random).as_matrix()),
        sphere(0.4, tuple(random.uniform([-1, -1, 2], [1, 1, 4])), subdivisions=1),
    )
    rendering = render(vertices, triangles, view)
    expected = cast_rays(vertices, triangles, view)
    differing = np.isfinite(expected) != rendering.silhouette
    # A pixel's centre may lie on an edge to rounding; then either answer is right.
    assert differing.sum() <= 1
    both = np.isfinite(expected) & rendering.silhouette
    np.testing.assert_allclose(rendering.depth[both], expected[both], rtol=1e-4)


def test_face_ids_name_the_triangle_whose_plane_has_the_depth():
    view = camera()
    rendering = rendered_sphere(0.5, 2.5, view)
    seen = rendering.silhouette
    ids = rendering.face_ids[seen]
    normals = rendering.triangle_normals[ids]
    corners = rendering.vertices[rendering.triangles[ids, 0]]
    points = pixel_rays(view)[seen] * rendering.depth[seen][:, None]
    distance_to_plane = ((points - corners) * normals).sum(axis=1)
    np.testing.assert_allclose(distance_to_plane, 0, atol=1e-6)
    assert rendering.front_facing[ids].all()


def test_a_tiled_surface_has_no_holes():
    # 80 000 triangles, most smaller than a pixel: any crack between two would show.
    rendering = render(*sphere(0.5, (0, 0, 2.5), subdivisions=6), camera(width=160, height=120))
    rows = np.flatnonzero(rendering.silhouette.any(axis=1))
    for row in rows:
        columns = np.flatnonzero(rendering.silhouette[row])
        assert len(columns) == columns[-1] - columns[0] + 1


def test_moving_the_principal_point_by_whole_pixels_moves_the_picture():
    vertices, triangles = sphere(0.3, (0.05, -0.02, 2.0))
    view = camera()
    moved_view = Camera(
        focal_length_px=view.focal_length_px,
        centre_x=view.centre_x + 7,
        centre_y=view.centre_y - 5,
        width=view.width,
        height=view.height,
    )
    still = render(vertices, triangles, view)
    moved = render(vertices, triangles, moved_view)
    np.testing.assert_array_equal(moved.face_ids, np.roll(still.face_ids, (-5, 7), axis=(0, 1)))


def test_scaling_scene_and_distance_together_changes_no_pixel():
    vertices, triangles = sphere(0.3, (0.05, -0.02, 2.0))
    small = render(vertices, triangles, camera())
    large = render(vertices * 4, triangles, camera())
    np.testing.assert_array_equal(small.face_ids, large.face_ids)
    np.testing.assert_allclose(large.depth, small.depth * 4, rtol=1e-6)


def test_a_body_beyond_the_border_is_cut_there():
    view = camera()
    wide = camera(width=3 * view.width, height=3 * view.height)
    mesh = sphere(0.5, (-0.9, -0.6, 2.5))
    cut = render(*mesh, view)
    whole = render(*mesh, wide)
    window = whole.face_ids[view.height : 2 * view.height, view.width : 2 * view.width]
    np.testing.assert_array_equal(cut.face_ids, window)
    assert 0 < cut.silhouette.sum() < whole.silhouette.sum()


def test_nothing_behind_the_camera_is_drawn():
    rendering = render(*sphere(0.5, (0, 0, -2.5)), camera())
    assert not rendering.silhouette.any()
    assert not rendering.vertex_visible.any()
    assert np.isinf(rendering.depth).all()


def test_a_body_through_the_near_plane_leaves_the_rest_finite():
    rendering = render(*sphere(1.0, (0, 0, 0.5)), camera())
    assert np.isfinite(rendering.projected).all()
    assert np.isfinite(rendering.vertex_normals).all()


def test_sphere_normals_point_from_its_centre():
    rendering = rendered_sphere(0.5, 2.5, camera())
    outward = (rendering.vertices - [0, 0, 2.5]) / 0.5
    assert ((rendering.vertex_normals * outward).sum(axis=1) > 0.9999).all()
    np.testing.assert_allclose(np.linalg.norm(rendering.triangle_normals, axis=1), 1, rtol=1e-12)


def test_a_flat_triangle_has_a_zero_normal_and_no_pixels():
    vertices = np.array([[0, 0, 2.0], [0.1, 0, 2.0], [0.2, 0, 2.0]])
    rendering = render(vertices, np.array([[0, 1, 2]]), camera())
    np.testing.assert_array_equal(rendering.triangle_normals, 0)
    assert not rendering.silhouette.any()


def test_the_visible_vertices_of_a_sphere_are_the_cap_facing_the_camera():
    rendering = rendered_sphere(0.5, 2.5, camera())
    to_rim = (rendering.vertex_normals * rendering.vertices).sum(axis=1)
    np.testing.assert_array_equal(rendering.vertex_visible, to_rim < 0)


def test_vertices_behind_another_body_are_not_visible():
    view = camera()
    front = sphere(0.2, (0, 0, 1.5))
    back = sphere(0.5, (0, 0, 3.0))
    rendering = render(*together(front, back), view)
    vertices = rendering.vertices[len(front[0]) :]
    visible = rendering.vertex_visible[len(front[0]) :]
    facing = (rendering.vertex_normals[len(front[0]) :] * vertices).sum(axis=1) < 0
    from_axis = np.hypot(vertices[:, 0], vertices[:, 1]) / vertices[:, 2]
    rim = 0.2 / np.sqrt(1.5**2 - 0.2**2)
    pixel = 1 / view.focal_length_px
    assert not visible[facing & (from_axis < rim - 2 * pixel)].any()
    assert visible[facing & (from_axis > rim + 2 * pixel)].all()


def test_vertices_outside_the_picture_are_not_visible():
    rendering = render(*sphere(0.5, (2.0, 0, 2.5)), camera())
    outside = rendering.projected[:, 0] >= 320
    assert outside.any()
    assert not rendering.vertex_visible[outside].any()


def ring() -> np.ndarray:
    rows, columns = np.mgrid[:200, :240] + 0.5
    radius = np.hypot(columns - 120.0, rows - 100.0)
    return (radius < 80.0) & (radius > 30.0)


def test_a_ring_has_an_outer_and_an_inner_loop_at_its_radii():
    outer, inner = outline_loops(ring())
    for loop, radius in ((outer, 80.0), (inner, 30.0)):
        found = np.hypot(*(loop - [120.0, 100.0]).T)
        assert np.abs(found - radius).max() < 1.5


def test_filled_by_the_even_odd_rule_the_loops_are_the_silhouette():
    silhouette = ring()
    filled = np.zeros(silhouette.shape, dtype=np.uint8)
    cv2.fillPoly(filled, [np.rint(x - 0.5).astype(np.int32) for x in outline_loops(silhouette)], 1)
    wrong = (filled > 0) != silhouette
    # At most the rim's own pixels, where straight pieces replace the staircase.
    assert wrong.sum() < 0.05 * silhouette.sum()


def test_specks_and_emptiness_have_no_outline():
    empty = np.zeros((20, 20), dtype=bool)
    assert outline_loops(empty) == ()
    speck = empty.copy()
    speck[4, 4] = True
    assert outline_loops(speck) == ()


def test_a_constant_fills_the_silhouette_and_the_background_stays():
    rendering = render(*sphere(0.5, (0, 0, 2.5)), camera())
    picture = shade_image(rendering, np.full(len(rendering.vertices), 0.7), background=-1.0)
    np.testing.assert_allclose(picture[rendering.silhouette], 0.7, rtol=1e-6)
    np.testing.assert_array_equal(picture[~rendering.silhouette], -1.0)


def test_interpolated_depth_is_the_depth_buffer():
    # z itself is linear on each triangle in space: a perspective-correct interpolation gives it.
    rendering = render(*box((1.0, 0.6, 2.0), (0.6, 0.4, 2.5)), camera())
    picture = shade_image(rendering, rendering.vertices[:, 2], background=np.inf)
    np.testing.assert_allclose(picture, rendering.depth, rtol=1e-5)
