"""Lighter surfaces made of a surface's own vertices."""

import numpy as np
import pytest
import trimesh

from fitter.body.model import LighterMesh
from fitter.training.shapes.decimation import decimated

LONGEST, ERROR = 0.3, 0.01


@pytest.fixture(scope="module")
def capsule() -> tuple[np.ndarray, np.ndarray]:
    mesh = trimesh.creation.capsule(height=2.0, radius=0.5, count=[24, 24])
    return np.array(mesh.vertices), np.array(mesh.faces)


@pytest.fixture(scope="module")
def held(capsule) -> np.ndarray:
    marks = np.zeros(len(capsule[0]), dtype=bool)
    marks[::17] = True
    return marks


@pytest.fixture(scope="module")
def lighter(capsule, held) -> LighterMesh:
    return decimated(*capsule, held=held, longest=LONGEST, error=ERROR)


def test_the_surface_stays_closed_whole_and_turned_outward(capsule, lighter):
    vertices, triangles = capsule
    mesh = trimesh.Trimesh(vertices[lighter.kept], lighter.triangles, process=False)
    assert len(lighter.kept) < 0.7 * len(vertices)
    assert mesh.is_watertight
    assert mesh.is_winding_consistent
    assert mesh.euler_number == 2
    whole = trimesh.Trimesh(vertices, triangles, process=False)
    assert mesh.volume == pytest.approx(whole.volume, rel=0.02)


def test_it_hardly_moves(capsule, lighter):
    vertices, _ = capsule
    mesh = trimesh.Trimesh(vertices[lighter.kept], lighter.triangles, process=False)
    _, distances, _ = trimesh.proximity.closest_point_naive(mesh, vertices)
    assert np.sqrt((distances**2).mean()) < ERROR
    assert distances.max() < 5.0 * ERROR


def test_held_vertices_and_those_at_long_edges_remain(capsule, held, lighter):
    vertices, triangles = capsule
    assert np.isin(np.flatnonzero(held), lighter.kept).all()
    shortest = np.full(len(vertices), np.inf)
    for one, other in ((0, 1), (1, 2), (2, 0)):
        length = np.linalg.norm(vertices[triangles[:, one]] - vertices[triangles[:, other]], axis=1)
        np.minimum.at(shortest, triangles[:, one], length)
        np.minimum.at(shortest, triangles[:, other], length)
    assert np.isin(np.flatnonzero(shortest >= LONGEST), lighter.kept).all()


def test_every_vertex_has_its_place_on_the_lighter_surface(capsule, lighter):
    vertices, triangles = capsule
    mesh = trimesh.Trimesh(vertices[lighter.kept], lighter.triangles, process=False)
    np.testing.assert_allclose(lighter.shares.sum(axis=1), 1.0)
    assert lighter.shares.min() >= 0.0
    placed = np.einsum("vc,vci->vi", lighter.shares, vertices[lighter.kept[lighter.corners]])
    np.testing.assert_allclose(placed[lighter.kept], vertices[lighter.kept], atol=1e-9)
    _, nearest, _ = trimesh.proximity.closest_point_naive(mesh, vertices)
    away = np.linalg.norm(placed - vertices, axis=1)
    assert np.percentile(away - nearest, 95) < 0.01 * ERROR
    assert (away < LONGEST).all()
    origins = vertices[triangles[lighter.origin]].mean(axis=1)
    remaining = vertices[lighter.kept[lighter.triangles]].mean(axis=1)
    assert np.linalg.norm(origins - remaining, axis=1).max() < 2.0 * LONGEST


def test_where_nothing_may_go_the_surface_is_the_same(capsule):
    vertices, triangles = capsule
    every = np.ones(len(vertices), dtype=bool)
    same = decimated(vertices, triangles, held=every, longest=LONGEST, error=ERROR)
    np.testing.assert_array_equal(same.kept, np.arange(len(vertices)))
    np.testing.assert_array_equal(same.triangles, triangles)
    short = decimated(vertices, triangles, held=~every, longest=1e-6, error=ERROR)
    np.testing.assert_array_equal(short.triangles, triangles)
