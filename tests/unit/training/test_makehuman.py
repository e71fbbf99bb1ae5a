"""MakeHuman: its mesh, and the landmarks on it."""

import numpy as np
import pytest

from fitter.body.model import SparseRows, regress
from fitter.numerics.meshes import enclosed_volume, triangle_neighbours
from fitter.training.makehuman.body_space import average_traits, source_vertices
from fitter.training.makehuman.meshes import BaseMesh, load_targets, makehuman_folder
from tests.unit.training import makehuman_data
from tests.unit.training.makehuman_data import base_mesh, body_space, needs_makehuman

pytestmark = needs_makehuman


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


@pytest.fixture(scope="module")
def landmarks() -> SparseRows:
    return makehuman_data.landmarks()


def points(landmarks: SparseRows, gender: str) -> dict[str, np.ndarray]:
    space = body_space(gender)
    vertices = source_vertices(space, average_traits(), space.neutral)
    found = regress(landmarks, base_mesh().body(vertices))
    return dict(zip(landmarks.names, found, strict=True))


def test_every_row_sums_to_one(landmarks: SparseRows):
    sums = np.add.reduceat(landmarks.weights, landmarks.pointers[:-1])
    np.testing.assert_allclose(sums, 1.0, atol=1e-9)


def test_landmarks_do_not_depend_on_where_the_body_stands(landmarks: SparseRows):
    body = base_mesh().body(base_mesh().source_vertices)
    moved = regress(landmarks, body + [1.0, 2.0, 3.0]) - regress(landmarks, body)
    np.testing.assert_allclose(moved, np.broadcast_to([1.0, 2.0, 3.0], moved.shape), atol=1e-9)


@pytest.mark.parametrize("gender", ["female", "male"])
def test_left_and_right_mirror_each_other(landmarks: SparseRows, gender: str):
    found = points(landmarks, gender)
    for name, point in found.items():
        swap = {"left": "right", "right": "left"}
        other = "_".join(swap.get(word, word) for word in name.split("_"))
        np.testing.assert_allclose(found[other] * [-1, 1, 1], point, atol=2e-3)
        if "left" in name:
            assert point[0] > 0.02


@pytest.mark.parametrize("gender", ["female", "male"])
def test_landmarks_stack_as_a_body_does(landmarks: SparseRows, gender: str):
    found = points(landmarks, gender)
    downwards = ["crown", "left_eye", "nose", "chin", "cervicale", "neck", "left_nipple", "navel"]
    downwards += ["crotch", "left_heel", "sole_left"]
    heights = np.array([found[name][1] for name in downwards])
    assert (np.diff(heights) < 0.0).all()
    assert found["navel"][2] > found["seat"][2]
    assert found["left_toe"][2] > found["left_heel"][2]
    assert 0.25 < found["left_acromion"][0] * 2 < 0.45


@pytest.mark.parametrize("gender", ["female", "male"])
def test_the_face_is_where_faces_have_it(landmarks: SparseRows, gender: str):
    found = points(landmarks, gender)
    eyes, mouth = (
        found[f"left_{name}"] - found[f"right_{name}"] for name in ("eye", "mouth_corner")
    )
    assert 0.055 < eyes[0] < 0.07
    assert 0.035 < mouth[0] < eyes[0]
    downwards = ["left_eye", "nose", "left_mouth_corner", "chin"]
    assert (np.diff([found[name][1] for name in downwards]) < -0.01).all()
    backwards = ["nose", "left_mouth_corner", "left_eye", "left_ear", "cervicale"]
    assert (np.diff([found[name][2] for name in backwards]) < -0.005).all()
    assert found["left_ear"][0] > found["left_eye"][0] + 0.03
