import numpy as np
import pytest
import trimesh
from scipy.spatial.transform import Rotation

from fitter.numerics.meshes import mesh_topology
from fitter.render.camera import Camera
from fitter.render.contours import ModelEdges, model_edges
from fitter.render.rasterizer import Rendering, render
from tests.unit.render.shapes import box, camera, sphere, together


def contours_of(mesh: tuple[np.ndarray, np.ndarray], view: Camera) -> tuple[Rendering, ModelEdges]:
    rendering = render(*mesh, view)
    return rendering, model_edges(rendering, mesh_topology(mesh[1], vertex_count=len(mesh[0])))


def midpoints(edges: ModelEdges) -> np.ndarray:
    return edges.endpoints.mean(axis=1)


def hidden(point: np.ndarray, vertices: np.ndarray, triangles: np.ndarray) -> bool:
    """The plain version: whether any triangle crosses the ray clearly before the point."""
    a, b, c = (vertices[triangles[:, i]] for i in range(3))
    first, second = b - a, c - a
    across = np.cross(point, second)
    determinant = (across * first).sum(axis=1)
    with np.errstate(divide="ignore", invalid="ignore"):
        u = -(across * a).sum(axis=1) / determinant
        q = np.cross(-a, first)
        v = (q @ point) / determinant
        share = (q * second).sum(axis=1) / determinant
    crossed = (u >= 0) & (v >= 0) & (u + v <= 1) & (share > 0) & (share < 0.999)
    return bool(crossed.any())


def test_model_edges_are_those_where_normal_times_ray_changes_sign():
    mesh = sphere(0.4, (0.3, -0.2, 2.0))
    rendering, edges = contours_of(mesh, camera())
    topology = mesh_topology(mesh[1], vertex_count=len(mesh[0]))
    rays = rendering.vertices[topology.edges].mean(axis=1)
    first, second = (
        (rendering.triangle_normals[topology.edge_triangles[:, side]] * rays).sum(axis=1)
        for side in (0, 1)
    )
    expected = {tuple(edge) for edge in topology.edges[(first < 0) != (second < 0)]}
    assert {tuple(sorted(edge)) for edge in edges.edges} == expected


def test_a_spheres_model_edges_trace_its_outline():
    view = camera()
    _, edges = contours_of(sphere(0.5, (0, 0, 2.5), subdivisions=5), view)
    outline_radius = view.focal_length_px * 0.5 / np.sqrt(2.5**2 - 0.5**2)
    from_centre = midpoints(edges) - [view.centre_x, view.centre_y]
    radii = np.linalg.norm(from_centre, axis=1)
    np.testing.assert_allclose(radii, outline_radius, atol=1.0)
    assert edges.visible.all()
    assert edges.is_outer_silhouette.all()


def test_outward_normals_point_away_from_the_body():
    view = camera()
    _, edges = contours_of(sphere(0.5, (0, 0, 2.5), subdivisions=5), view)
    from_centre = midpoints(edges) - [view.centre_x, view.centre_y]
    assert ((edges.outward * from_centre).sum(axis=1) > 0).all()
    np.testing.assert_allclose(np.linalg.norm(edges.outward, axis=1), 1, rtol=1e-12)
    along = edges.endpoints[:, 1] - edges.endpoints[:, 0]
    np.testing.assert_allclose((along * edges.outward).sum(axis=1), 0, atol=1e-9)


def test_a_cube_seen_face_on_shows_the_four_edges_of_that_face():
    vertices, triangles = box((0.5, 0.5, 0.5), (0, 0, 2.0))
    _, edges = contours_of((vertices, triangles), camera())
    assert len(edges.edges) == 4
    np.testing.assert_allclose(vertices[edges.edges, 2], 1.75)
    np.testing.assert_allclose(np.abs(edges.endpoints - [160, 120]), 400 * 0.25 / 1.75)
    assert edges.is_outer_silhouette.all()


def test_a_cube_seen_corner_on_shows_its_hexagon_and_none_of_its_creases():
    rotation = Rotation.align_vectors([[0, 0, -1]], [[1, 1, 1]])[0].as_matrix()
    _, edges = contours_of(box((0.5, 0.5, 0.5), (0, 0, 2.0), rotation=rotation), camera())
    assert len(edges.edges) == 6
    assert edges.is_outer_silhouette.all()


def test_a_body_part_before_another_has_an_inner_contour():
    view = camera()
    front = sphere(0.15, (0, 0, 1.5))
    back = sphere(0.5, (0, 0, 3.0))
    _, edges = contours_of(together(front, back), view)
    of_front = edges.edges[:, 0] < len(front[0])
    assert edges.visible.all()
    assert not edges.is_outer_silhouette[of_front].any()
    assert edges.is_outer_silhouette[~of_front].all()


def test_a_contour_behind_another_body_part_is_hidden():
    back = sphere(0.1, (0, 0, 3.0))
    front = sphere(0.3, (0, 0, 1.5))
    _, edges = contours_of(together(back, front), camera())
    of_back = edges.edges[:, 0] < len(back[0])
    assert of_back.any()
    assert not edges.visible[of_back].any()
    assert edges.visible[~of_back].all()


@pytest.mark.parametrize("tilt_degrees", [35, 75])
def test_visibility_agrees_with_casting_rays_on_a_surface_that_hides_itself(tilt_degrees: int):
    torus = trimesh.creation.torus(
        major_radius=0.5, minor_radius=0.2, major_sections=48, minor_sections=24
    )
    tilt = Rotation.from_euler("x", tilt_degrees, degrees=True).as_matrix()
    vertices = np.array(torus.vertices) @ tilt.T + [0, 0, 2.5]
    triangles = np.array(torus.faces, dtype=np.int32)
    view = camera(width=640, height=480)
    _, edges = contours_of((vertices, triangles), view)
    # To the z-buffer's pixel: an edge a hair behind a rim may pass for visible, no farther.
    steps = np.array([[0, 0, 0], [1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0]])
    for edge, visible in zip(edges.edges, edges.visible, strict=True):
        point = vertices[edge].mean(axis=0)
        around = point + steps * 1.5 * point[2] / view.focal_length_px
        is_hidden = [hidden(neighbour, vertices, triangles) for neighbour in around]
        if not is_hidden[0]:
            assert visible
        elif all(is_hidden):
            assert not visible


def test_edges_outside_the_picture_are_not_visible():
    view = camera()
    _, edges = contours_of(sphere(0.5, (0.9, 0, 2.5)), view)
    outside = midpoints(edges)[:, 0] >= view.width
    assert outside.any()
    assert not outside.all()
    assert not edges.visible[outside].any()
    assert edges.visible[~outside].all()


def test_a_body_behind_the_camera_has_no_model_edges():
    _, edges = contours_of(sphere(0.5, (0, 0, -2.5)), camera())
    assert len(edges.edges) == 0
