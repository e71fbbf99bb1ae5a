import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from fitter.numerics.meshes import enclosed_volume, triangle_neighbours, volume_gradient
from tests.unit.measurement.solids import prism, sphere

SQUARE = [(0, 0), (0, 1), (1, 1), (1, 0)]


def test_a_box_has_the_volume_of_its_sides():
    vertices, triangles = prism(SQUARE, heights=[0.0, 0.5, 2.0])
    assert enclosed_volume(vertices * [1.0, 1.0, 3.0], triangles) == pytest.approx(6.0, abs=1e-12)


def test_a_box_turned_inside_out_has_negative_volume():
    vertices, triangles = prism(SQUARE, heights=[0.0, 1.0])
    assert enclosed_volume(vertices, triangles[:, ::-1]) == pytest.approx(-1.0)


def test_volume_does_not_depend_on_where_the_body_stands_or_turns():
    vertices, triangles = sphere(radius=0.4)
    rotation = Rotation.from_rotvec([1.0, 2.0, -0.5]).as_matrix()
    moved = vertices @ rotation.T + [100.0, -50.0, 7.0]
    volume = enclosed_volume(vertices, triangles)
    assert volume == pytest.approx(4 / 3 * np.pi * 0.4**3, rel=2e-4)
    assert enclosed_volume(moved, triangles) == pytest.approx(volume, rel=1e-12)


def test_the_gradient_of_a_volume_is_that_of_finite_differences():
    vertices, triangles = prism(SQUARE, heights=[0.0, 0.5, 2.0])
    change = np.random.default_rng(1).normal(size=vertices.shape)
    ahead, behind = (enclosed_volume(vertices + step * change, triangles) for step in (1e-4, -1e-4))
    slope = float((volume_gradient(vertices, triangles) * change).sum())
    assert slope == pytest.approx((ahead - behind) / 2e-4, rel=1e-7)


def test_neighbours_share_the_edge_they_are_listed_for():
    _, triangles = prism(SQUARE, heights=[0.0, 1.0, 2.0])
    neighbours = triangle_neighbours(triangles)
    assert (neighbours >= 0).all()
    for triangle, across in zip(triangles, neighbours, strict=True):
        for corner in range(3):
            edge = {int(triangle[corner]), int(triangle[(corner + 1) % 3])}
            assert edge < {int(v) for v in triangles[across[corner]]}


def test_an_edge_of_an_open_mesh_has_no_neighbour():
    assert triangle_neighbours(np.array([[0, 1, 2], [0, 2, 3]])).tolist() == [
        [-1, -1, 1],
        [0, -1, -1],
    ]
